// Runs a fuzz target over its corpus and over mutations of every file in it, without libFuzzer: the test
// suite does so with every build type and compiler. If a requirement is violated the program aborts; the last
// line of stderr then names the input by its file and the mutation's number (0: none), and --write reproduces
// it.
//
//   replay_TARGET CORPUS [MUTATIONS]                        run every file and MUTATIONS mutations of each
//   replay_TARGET CORPUS --write DIRECTORY                  write the files' inputs as bytes, for libFuzzer
//   replay_TARGET CORPUS --write DIRECTORY FILE MUTATION    write the input of one mutation
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <string>

#include "tests/fuzz/corpus.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace buoyancy {
namespace {

void write(const std::filesystem::path& path, const FuzzInput& input) {
  std::ofstream file(path, std::ios::binary);
  for (const std::uint8_t byte : input) file.put(static_cast<char>(byte));
}

FuzzInput mutation_of(const std::vector<CorpusFile>& files, std::size_t place, std::size_t number) {
  return mutated(files[place].input, files[(place + number) % files.size()].input, number);
}

int replay(const std::vector<CorpusFile>& files, std::size_t mutations) {
  for (std::size_t place = 0; place < files.size(); ++place) {
    std::fprintf(stderr, "%s:", files[place].name.c_str());
    for (std::size_t number = 0; number <= mutations; ++number) {
      const FuzzInput input = number == 0 ? files[place].input : mutation_of(files, place, number);
      std::fprintf(stderr, " %zu", number);
      LLVMFuzzerTestOneInput(input.data(), input.size());
    }
    std::fprintf(stderr, "\n");
  }
  std::printf("%zu files, %zu runs, no findings\n", files.size(), files.size() * (1 + mutations));
  return 0;
}

int write_inputs(const std::vector<CorpusFile>& files, const std::filesystem::path& directory) {
  for (const CorpusFile& file : files) write(directory / file.name, file.input);
  return 0;
}

int write_mutation(const std::vector<CorpusFile>& files, const std::filesystem::path& directory,
                   const std::string& name, std::size_t number) {
  for (std::size_t place = 0; place < files.size(); ++place) {
    if (files[place].name != name) continue;
    write(directory / (name + "." + std::to_string(number)), mutation_of(files, place, number));
    return 0;
  }
  throw std::runtime_error(name + ": not found in the corpus");
}

int main_of(const std::vector<std::string>& arguments) {
  const std::size_t count = arguments.size();
  const bool writes = count >= 3 && arguments[1] == "--write";
  if (count == 0 || count > 5 || (count > 2 && !writes) || count == 4) {
    std::fprintf(stderr,
                 "usage: replay_TARGET CORPUS [MUTATIONS]\n       replay_TARGET CORPUS --write DIRECTORY "
                 "[FILE MUTATION]\n");
    return 2;
  }
  const std::vector<CorpusFile> files = read_corpus(arguments[0]);
  if (count == 5) return write_mutation(files, arguments[2], arguments[3], std::stoul(arguments[4]));
  if (writes) return write_inputs(files, arguments[2]);
  return replay(files, count == 2 ? std::stoul(arguments[1]) : 0);
}

}  // namespace
}  // namespace buoyancy

int main(int count, char** arguments) {
  try {
    return buoyancy::main_of({arguments + 1, arguments + count});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
