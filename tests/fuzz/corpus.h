// The corpus in tests/fuzz/corpus: small inputs that seed the fuzzer, and inputs of former findings.
//
// A file contains the input's bytes, except files named *.hex: these are text, words of pairs of hexadecimal
// digits. 600*00 is a word that is repeated, @NAME the content of corpus/parts/NAME.hex, and # starts a
// comment to the end of the line.
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

// Returns the files sorted by name. Throws std::runtime_error if the directory contains no file or an invalid
// .hex file.
std::vector<CorpusFile> read_corpus(const std::filesystem::path& directory);

// Returns a mutation of the input: a few bytes changed, inserted, repeated or removed, or its head joined to
// the tail of `other`. The same arguments give the same result on every machine.
FuzzInput mutated(const FuzzInput& input, const FuzzInput& other, std::uint64_t seed);

}  // namespace buoyancy
