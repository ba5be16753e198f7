#include "geometry/ply_header.h"

#include <algorithm>
#include <sstream>

namespace buoyancy {

std::uint64_t PlyHeader::count_of(std::string_view name) const {
  const auto found = std::ranges::find(elements, name, &PlyElement::name);
  return found == elements.end() ? 0 : found->count;
}

std::optional<PlyHeader> read_ply_header(std::istream& file) {
  constexpr std::streamoff kMaxHeaderBytes = 1'000'000;
  file.clear();
  file.seekg(0);
  PlyHeader header;
  for (std::string line; file.tellg() < kMaxHeaderBytes && std::getline(file, line);) {
    if (line.starts_with("end_header")) {
      header.data_follows = (file >> std::ws).peek() != std::istream::traits_type::eof();
      return header;
    }
    std::istringstream words(line);
    std::string keyword;
    PlyElement element;
    if (words >> keyword >> element.name >> element.count && keyword == "element") {
      header.elements.push_back(std::move(element));
    }
  }
  return std::nullopt;
}

}  // namespace buoyancy
