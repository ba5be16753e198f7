// A Markdown table with aligned columns, for terminals and documents.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

namespace buoyancy::bench {

class MarkdownTable {
 public:
  explicit MarkdownTable(std::vector<std::string> header) : rows_{std::move(header)} {}

  // Adds a row with as many cells as the header.
  void add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }

  // Prints the table and an empty line. The first `text_columns` columns are left-aligned, the others
  // right-aligned.
  void print(std::FILE* file, std::size_t text_columns) const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

std::string format_cell(const char* format, double value);  // printf format

inline std::string pass_or_fail(bool holds) {
  return holds ? "met" : "MISSED";
}

}  // namespace buoyancy::bench
