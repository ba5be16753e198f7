// The corpus in tests/fuzz/corpus: small inputs that seed the fuzzer, and those that once broke something.
//
// A file is an input as it stands, but for names that end in .hex: these are text, pairs of hexadecimal
// digits, where white space is passed over and # begins a remark that ends with its line.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace buoyancy {

using FuzzInput = std::vector<std::uint8_t>;

struct CorpusFile {
  std::string name;
  FuzzInput input;
};

// In the order of their names. Throws std::runtime_error where the directory holds no file, or one that says
// .hex and is not.
std::vector<CorpusFile> read_corpus(const std::filesystem::path& directory);

// One of the input's neighbours: a few bytes changed, inserted, repeated or left out, or its head before
// another's tail. The same for the same arguments, on every machine.
FuzzInput mutated(const FuzzInput& input, const FuzzInput& other, std::uint64_t seed);

}  // namespace buoyancy
