#include "tests/random_search/search_engine.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <thread>

namespace buoyancy {
namespace {

constexpr std::size_t kMaxFailures = 100;
constexpr double kBinsPerDecade = 20.0;
constexpr double kLastBin = 199.0;

std::string row_of(const std::string& name, const std::vector<std::string>& cells) {
  std::string text = "| " + name + " |";
  for (const std::string& cell : cells) text += cell.empty() ? " |" : " " + cell + " |";
  return text + "\n";
}

}  // namespace

std::int64_t SearchFigures::count(const std::string& name) const {
  const auto found = counts.find(name);
  return found == counts.end() ? 0 : found->second;
}

double SearchFigures::most(const std::string& name) const {
  const auto found = largest.find(name);
  return found == largest.end() ? 0.0 : found->second.value;
}

void SearchFigures::add_ratio(double ratio) {
  const double bin = std::isfinite(ratio) ? kBinsPerDecade * std::log10(ratio) : kLastBin;
  ++ratios[static_cast<int>(std::clamp(bin, 0.0, kLastBin))];
}

double SearchFigures::median_ratio() const {
  std::int64_t total = 0;
  for (const auto& [bin, number] : ratios) total += number;
  std::int64_t below = 0;
  for (const auto& [bin, number] : ratios) {
    below += number;
    if (2 * below >= total) return std::pow(10.0, (bin + 0.5) / kBinsPerDecade);
  }
  return 0.0;
}

SearchFigures& SearchFigures::operator+=(const SearchFigures& other) {
  for (const auto& [name, number] : other.counts) counts[name] += number;
  for (const auto& [name, found] : other.largest) largest[name].add(found.value, found.at);
  for (const auto& [bin, number] : other.ratios) ratios[bin] += number;
  return *this;
}

SearchFigures SearchStats::total() const {
  SearchFigures sum;
  for (const auto& [name, figures] : rows) sum += figures;
  return sum;
}

void SearchStats::add_violations(std::int64_t number, const std::string& text,
                                 const std::vector<std::string>& violations) {
  if (violations.empty()) return;
  ++failed_cases;
  if (failures.size() < kMaxFailures) failures.push_back({number, text, violations});
}

SearchStats& SearchStats::operator+=(const SearchStats& other) {
  cases += other.cases;
  failed_cases += other.failed_cases;
  for (const auto& [name, figures] : other.rows) rows[name] += figures;
  for (const SearchFailure& failure : other.failures) {
    if (failures.size() < kMaxFailures) failures.push_back(failure);
  }
  return *this;
}

SearchColumn count_column(const char* title, const char* what) {
  return {title, [what](const SearchFigures& figures) { return std::to_string(figures.count(what)); }};
}

SearchColumn largest_column(const char* title, const char* what) {
  return {title, [what](const SearchFigures& figures) {
            const double most = figures.most(what);
            return most > 0.0 ? two_digits(most) : std::string();
          }};
}

std::string RandomSearch::table(const SearchStats& stats) const {
  std::vector<std::string> cells;
  for (const SearchColumn& column : columns) cells.push_back(column.title);
  std::string text = row_of(first_column, cells);
  text += "|---|";
  for (std::size_t i = 0; i < columns.size(); ++i) text += "---:|";
  text += "\n";
  const auto add = [&](const std::string& row, const SearchFigures& figures) {
    cells.clear();
    for (const SearchColumn& column : columns) cells.push_back(column.cell(figures));
    text += row_of(row, cells);
  };
  for (const std::string& row : rows) {
    const auto found = stats.rows.find(row);
    add(row, found == stats.rows.end() ? SearchFigures{} : found->second);
  }
  if (has_total) add("all", stats.total());
  return text;
}

std::string RandomSearch::summary(const SearchStats& stats) const {
  const SearchFigures total = stats.total();
  std::string text = std::to_string(stats.cases) + " cases";
  for (const auto& [what, number] : total.counts) {
    if (what != "cases") text += ", " + std::to_string(number) + " " + what;
  }
  text += ", " + std::to_string(stats.failed_cases) + " violations";
  std::string separator = "; largest ";
  for (const auto& [what, found] : total.largest) {
    text += separator + what + " " + two_digits(found.value) + " (case " + std::to_string(found.at) + ")";
    separator = ", ";
  }
  return text;
}

std::string two_digits(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2g", value);
  return text.data();
}

void in_parallel(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next{0};
  const auto loop = [&] {
    for (std::size_t i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::jthread> others;
  for (unsigned n = 1; n < threads; ++n) others.emplace_back(loop);
  loop();
}

SearchStats sum_in_parallel(std::size_t count, unsigned threads,
                            const std::function<SearchStats(std::size_t)>& part) {
  std::vector<SearchStats> parts(count);
  in_parallel(count, threads, [&](std::size_t i) { parts[i] = part(i); });
  SearchStats total;
  for (const SearchStats& stats : parts) total += stats;
  return total;
}

}  // namespace buoyancy
