// Reads the header of a PLY file without an importer, to explain files that an importer misreads.
#pragma once

#include <cstdint>
#include <istream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace buoyancy {

struct PlyElement {
  std::string name;  // "vertex", "face"
  std::uint64_t count = 0;
};

struct PlyHeader {
  std::vector<PlyElement> elements;
  bool data_follows = false;  // bytes follow the header

  std::uint64_t count_of(std::string_view name) const;  // 0 if not declared
};

// Reads from the stream's beginning. Returns nullopt if the first 1,000,000 bytes have no 'end_header' line.
std::optional<PlyHeader> read_ply_header(std::istream& file);

}  // namespace buoyancy
