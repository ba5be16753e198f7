// A table that reads well in a terminal and is Markdown in a document.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

namespace buoyancy::bench {

class MarkdownTable {
 public:
  explicit MarkdownTable(std::vector<std::string> header) : rows_{std::move(header)} {}

  // As many cells as the header has.
  void add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }

  // The first `text_columns` columns to the left, the others to the right. An empty line follows.
  void print(std::FILE* file, std::size_t text_columns) const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

std::string format_cell(const char* format, double value);  // of a cell, as printf has it

inline std::string pass_or_fail(bool holds) {
  return holds ? "met" : "MISSED";
}

}  // namespace buoyancy::bench
