// Reads CSV files of the programs: fields without quotes, the first row the names of the columns.
#pragma once

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace buoyancy {

using CsvRow = std::vector<std::string>;

inline std::vector<CsvRow> csv_rows(const std::string& csv) {
  std::vector<CsvRow> rows;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    CsvRow& row = rows.emplace_back();
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) row.push_back(field);
  }
  return rows;
}

// The numbers of a row.
inline std::vector<double> numbers_of(const CsvRow& row) {
  std::vector<double> numbers;
  for (const std::string& field : row) numbers.push_back(std::stod(field));
  return numbers;
}

// The numbers of the column with this name.
inline std::vector<double> csv_column(const std::string& csv, const std::string& name) {
  const std::vector<CsvRow> rows = csv_rows(csv);
  const auto column = static_cast<std::size_t>(std::ranges::find(rows.at(0), name) - rows[0].begin());
  EXPECT_LT(column, rows[0].size()) << name;
  std::vector<double> values;
  for (std::size_t i = 1; i < rows.size(); ++i) values.push_back(std::stod(rows[i].at(column)));
  return values;
}

}  // namespace buoyancy
