#include "markdown_table.h"

#include <algorithm>
#include <array>

namespace buoyancy::bench {

void MarkdownTable::print(std::FILE* file, std::size_t text_columns) const {
  std::vector<std::size_t> widths(rows_[0].size(), 3);
  for (const auto& row : rows_) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  for (std::size_t n = 0; n < rows_.size(); ++n) {
    for (std::size_t i = 0; i < widths.size(); ++i) {
      const int width = static_cast<int>(widths[i]);
      std::fprintf(file, i < text_columns ? "| %-*s " : "| %*s ", width, rows_[n][i].c_str());
    }
    std::fprintf(file, "|\n");
    if (n > 0) continue;
    for (std::size_t i = 0; i < widths.size(); ++i) {
      const std::string dashes(widths[i], '-');
      std::fprintf(file, i < text_columns ? "|-%s-" : "|-%s:", dashes.c_str());
    }
    std::fprintf(file, "|\n");
  }
  std::fprintf(file, "\n");
}

std::string format_cell(const char* format, double value) {
  std::array<char, 64> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, value);
  return buffer.data();
}

}  // namespace buoyancy::bench
