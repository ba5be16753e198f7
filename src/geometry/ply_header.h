// What the header of a PLY file announces, read without an importer to explain what an importer would
// misread.
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
  bool data_follows = false;  // there are bytes after the header

  std::uint64_t count_of(std::string_view name) const;  // 0 where it is not announced
};

// From the stream's beginning. nullopt: no 'end_header' line within the length that headers have.
std::optional<PlyHeader> read_ply_header(std::istream& file);

}  // namespace buoyancy
