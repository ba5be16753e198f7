// What the random searches have in common: figures that add up, tables and threads. A search
// draws cases and checks a rule. Cases are numbered from 0; each depends only on the seed and its number, not
// on the number of threads or on where a run begins.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace buoyancy {

struct Largest {
  double value = 0.0;
  std::int64_t at = -1;  // the case's number

  void add(double candidate, std::int64_t number) {
    if (candidate > value) *this = {candidate, number};
  }
};

// The figures of one row of a search's table.
struct SearchFigures {
  std::map<std::string, std::int64_t> counts;
  std::map<std::string, Largest> largest;
  std::map<int, std::int64_t> ratios;  // how many ratios are in each twentieth of a decade, from 1 on

  std::int64_t count(const std::string& name) const;
  double most(const std::string& name) const;
  void add_ratio(double ratio);
  double median_ratio() const;  // 0 if there is none
  SearchFigures& operator+=(const SearchFigures& other);
};

struct SearchFailure {
  std::int64_t number = 0;
  std::string text;  // of the case, in lines
  std::vector<std::string> violations;
};

// The results of a run; those of several runs can be added.
struct SearchStats {
  std::int64_t cases = 0;
  std::int64_t failed_cases = 0;
  std::map<std::string, SearchFigures> rows;
  std::vector<SearchFailure> failures;  // the first hundred

  SearchFigures total() const;
  // Counts the case as failed if there are violations.
  void add_violations(std::int64_t number, const std::string& text,
                      const std::vector<std::string>& violations);
  SearchStats& operator+=(const SearchStats& other);
};

struct SearchColumn {
  std::string title;
  std::function<std::string(const SearchFigures&)> cell;
};

// The columns of a count, and of a largest value.
SearchColumn count_column(const char* title, const char* what);
SearchColumn largest_column(const char* title, const char* what);

struct RandomSearch {
  std::string name;         // of its option; that of the first is empty
  std::string description;  // an imperative
  std::int64_t unit = 1;    // runs begin and end at multiples of this number
  // Runs the cases begin <= number < end.
  SearchStats (*run)(std::uint64_t seed, std::int64_t begin, std::int64_t end, unsigned threads) = nullptr;
  // One case, with everything that is known about it.
  SearchFailure (*replay)(std::uint64_t seed, std::int64_t number) = nullptr;
  std::string first_column;
  std::vector<std::string> rows;
  std::vector<SearchColumn> columns;
  bool has_total = false;  // as the last row

  std::string table(const SearchStats& stats) const;  // in Markdown
  // In one line: the counts, and the largest values with the cases' numbers.
  std::string summary(const SearchStats& stats) const;
};

// "1.2e-09", with two digits.
std::string two_digits(double value);

// Calls work(i) for i < count, on this many threads.
void in_parallel(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& work);

// Adds up the results of parts that run in parallel, in their order.
SearchStats sum_in_parallel(std::size_t count, unsigned threads,
                            const std::function<SearchStats(std::size_t)>& part);

}  // namespace buoyancy
