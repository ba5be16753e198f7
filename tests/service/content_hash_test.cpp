#include "service/replay/content_hash.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace buoyancy::service {
namespace {

std::string hash_of(Bytes bytes, std::size_t piece) {
  ContentHash hash;
  for (std::size_t start = 0; start < bytes.size(); start += piece) {
    hash.update(bytes.subspan(start, std::min(piece, bytes.size() - start)));
  }
  return hash.text();
}

// What xxhsum -H2 prints.
TEST(ContentHash, AgreesWithXxhsum) {
  EXPECT_EQ(ContentHash().text(), "xxh128:99aa06d3014798d86001c324468d497f");
  EXPECT_EQ(hash_of(std::vector<std::uint8_t>{'a', 'b', 'c'}, 3), "xxh128:06b05ab6733a618578af5f94892f3950");
}

TEST(ContentHash, DoesNotDependOnPieces) {
  std::vector<std::uint8_t> bytes(100'000);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i * i + (i >> 8));
  for (const std::size_t piece : {1UL, 3UL, 240UL, 1024UL, 65'537UL, 100'000UL}) {
    EXPECT_EQ(hash_of(bytes, piece), "xxh128:d35421d235e5d1714aebf23d41301cd1") << piece;
  }
}

}  // namespace
}  // namespace buoyancy::service
