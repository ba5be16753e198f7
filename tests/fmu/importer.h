// A host of FMUs: unpacks one into a temporary directory, loads its shared library, and calls the functions
// of either version of the standard by their names.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <dlfcn.h>

#include "service/fmu/fmu_package.h"
#include "tests/support/temp_dir.h"

namespace buoyancy::fmu {

constexpr int kFmiOk = 0;
constexpr int kFmiWarning = 1;
constexpr int kFmiError = 3;

// An FMU of a scene, unpacked in both versions.
class UnpackedFmu {
 public:
  // text: of the scene file.
  explicit UnpackedFmu(const std::string& text, const std::vector<std::string>& bodies = {})
      : content_(made(dir_.write("the scene.toml", text), bodies)) {
    for (const FmiVersion version : {FmiVersion::k2, FmiVersion::k3}) {
      for (const service::FmuFile& file : service::fmu_files(content_, version)) {
        const std::filesystem::path path = folder(version) / file.path;
        std::filesystem::create_directories(path.parent_path());
        dir_.write(std::filesystem::relative(path, dir_.path()).string(), file.bytes);
      }
    }
  }

  const ModelDescription& model() const { return content_.model; }
  const VariableTable& table() const { return content_.table; }
  std::filesystem::path folder(FmiVersion version) const {
    return dir_.path() / (version == FmiVersion::k2 ? "fmi 2" : "fmi 3");
  }
  std::filesystem::path shared_object(FmiVersion version) const {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder(version) / "binaries")) {
      if (entry.path().extension() == ".so") return entry.path();
    }
    throw std::runtime_error("no shared library");
  }

 private:
  static service::FmuContent made(const std::string& scene, const std::vector<std::string>& bodies) {
    Expected<service::FmuContent> content = service::fmu_content(scene, "model", bodies);
    if (!content) throw std::runtime_error(content.error().message());
    return *std::move(content);
  }

  TempDir dir_;
  service::FmuContent content_;
};

using References = std::vector<std::uint32_t>;

class Importer {
 public:
  Importer(const UnpackedFmu& fmu, FmiVersion version)
      : fmu_(fmu),
        version_(version),
        library_(::dlopen(fmu.shared_object(version).c_str(), RTLD_NOW | RTLD_LOCAL)) {
    if (library_ == nullptr) throw std::runtime_error(::dlerror());
    callbacks_ = {reinterpret_cast<void*>(&log_2), nullptr, nullptr, nullptr, this};
    instantiate(fmu.model().token);
  }
  Importer(const Importer&) = delete;
  Importer& operator=(const Importer&) = delete;
  ~Importer() {
    free();
    ::dlclose(library_);
  }

  void instantiate(const std::string& token) {
    const std::filesystem::path resources = fmu_.folder(version_) / "resources";
    if (version_ == FmiVersion::k3) {
      instance_ = function<void*(const char*, const char*, const char*, bool, bool, bool, bool,
                                 const std::uint32_t*, std::size_t, void*, void*, void*)>(
          "InstantiateCoSimulation")("instance", token.c_str(), (resources / "").c_str(), false, true, false,
                                     false, nullptr, 0, this, reinterpret_cast<void*>(&log_3), nullptr);
      return;
    }
    std::string uri = "file://" + resources.string();
    for (std::size_t at = 0; (at = uri.find(' ', at)) != std::string::npos;) uri.replace(at, 1, "%20");
    instance_ = function<void*(const char*, int, const char*, const char*, const void*, int, int)>(
        "Instantiate")("instance", 1, token.c_str(), uri.c_str(), &callbacks_, 0, 1);
  }
  void free() { function<void(void*)>("FreeInstance")(std::exchange(instance_, nullptr)); }
  void* instance() const { return instance_; }
  FmiVersion version() const { return version_; }

  // name: without "fmi2" or "fmi3". The arguments have exactly the types of the standard.
  template <typename... Arguments>
  int call(const std::string& name, Arguments... arguments) const {
    return function<int(void*, Arguments...)>(name)(instance_, arguments...);
  }

  int enter_initialization(double start = 0.0) const {
    if (version_ == FmiVersion::k3) {
      return call("EnterInitializationMode", false, 0.0, start, false, 0.0);
    }
    const int status = call("SetupExperiment", 0, 0.0, start, 0, 0.0);
    return std::max(status, call("EnterInitializationMode"));
  }
  // Enters and leaves the initialisation.
  int initialize(double start = 0.0) const {
    const int status = enter_initialization(start);
    return std::max(status, call("ExitInitializationMode"));
  }
  int step(double time, double step) const {
    if (version_ == FmiVersion::k2) return call("DoStep", time, step, 1);
    bool event = false, terminate = false, early = false;
    double last = 0.0;
    return call("DoStep", time, step, true, &event, &terminate, &early, &last);
  }

  const Variable& variable(const std::string& name) const {
    for (const Variable& known : fmu_.table().variables()) {
      if (known.name == name) return known;
    }
    throw std::runtime_error("no variable " + name);
  }
  References references(const std::string& name) const {
    const Variable& of = variable(name);
    References all{static_cast<std::uint32_t>(of.first)};
    while (version_ == FmiVersion::k2 && all.size() < of.size) all.push_back(all.back() + 1);
    return all;
  }
  int set(const std::string& name, const std::vector<double>& values) const {
    return set(references(name), values);
  }
  int set(const References& of, const std::vector<double>& values) const {
    if (version_ == FmiVersion::k2) return call("SetReal", of.data(), of.size(), values.data());
    return call("SetFloat64", of.data(), of.size(), values.data(), values.size());
  }
  int get(const std::string& name, std::vector<double>& values) const {
    values.resize(variable(name).size);
    const References of = references(name);
    if (version_ == FmiVersion::k2) return call("GetReal", of.data(), of.size(), values.data());
    return call("GetFloat64", of.data(), of.size(), values.data(), values.size());
  }
  std::vector<double> get(const std::string& name) const {
    std::vector<double> values;
    get(name, values);
    return values;
  }
  int status_of(const std::string& body) const {
    const References of = references(body + ".status");
    std::int32_t value = -1;
    if (version_ == FmiVersion::k2) {
      call("GetInteger", of.data(), of.size(), &value);
    } else {
      call("GetInt32", of.data(), of.size(), &value, std::size_t{1});
    }
    return value;
  }
  int derivative(const std::string& unknown, const std::string& known, const std::vector<double>& seed,
                 std::vector<double>& sensitivity) const {
    const References unknowns = references(unknown), knowns = references(known);
    sensitivity.resize(variable(unknown).size);
    if (version_ == FmiVersion::k2) {
      return call("GetDirectionalDerivative", unknowns.data(), unknowns.size(), knowns.data(), knowns.size(),
                  seed.data(), sensitivity.data());
    }
    return call("GetDirectionalDerivative", unknowns.data(), unknowns.size(), knowns.data(), knowns.size(),
                seed.data(), seed.size(), sensitivity.data(), sensitivity.size());
  }

  std::vector<std::string> log;  // "logStatusWarning: ..."

  template <typename Signature>
  Signature* function(const std::string& name) const {
    const std::string full = (version_ == FmiVersion::k2 ? "fmi2" : "fmi3") + name;
    void* const symbol = ::dlsym(library_, full.c_str());
    if (symbol == nullptr) throw std::runtime_error("no function " + full);
    return reinterpret_cast<Signature*>(symbol);
  }

 private:
  struct Callbacks {
    void *logger, *allocate, *free, *finished, *environment;
  };

  static void log_3(void* environment, int, const char* category, const char* message) {
    static_cast<Importer*>(environment)->log.push_back(std::string(category) + ": " + message);
  }
  static void log_2(void* environment, const char*, int, const char* category, const char* message, ...) {
    static_cast<Importer*>(environment)->log.push_back(std::string(category) + ": " + message);
  }

  const UnpackedFmu& fmu_;
  FmiVersion version_;
  void* library_;
  Callbacks callbacks_{};
  void* instance_ = nullptr;
};

}  // namespace buoyancy::fmu
