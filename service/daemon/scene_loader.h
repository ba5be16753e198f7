// Loads a scene on a background thread while the service handles requests with the current one: importing
// meshes may take seconds, and no request waits for it.
//
// Contract: after request() a load begins that reads the files as they are then or later. Any number of
// requests during a load cause exactly one further load. The result of a load is kept for poll(); the result
// of a later load replaces it. Nothing else is shared with the thread: ownership of the scene moves to the
// caller.
#pragma once

#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "base/error.h"
#include "base/unique_fd.h"
#include "scene/scene.h"

namespace buoyancy::service {

// The error of a load for which there was not enough memory.
Error out_of_memory_for(const std::string& scene);

class SceneLoader {
 public:
  using Loaded = Expected<std::unique_ptr<const Scene>>;

  // path: the scene file. Starts the thread, which inherits the caller's signal mask.
  explicit SceneLoader(std::filesystem::path path);
  SceneLoader(const SceneLoader&) = delete;
  SceneLoader& operator=(const SceneLoader&) = delete;
  // Waits for a load in progress, which may take as long as the scene's limits allow. A program that has to
  // exit at once checks is_loading() and exits without running the destructor.
  ~SceneLoader();

  void request();           // returns at once
  bool is_loading() const;  // is a load in progress or requested?

  // A descriptor for poll(2), readable when poll() has a result. Negative: the system provided none.
  int fileno() const { return ended_.value(); }
  // The scene of the load that has finished, or why it failed (std::bad_alloc included); nullopt: no load has
  // finished since the last call.
  std::optional<Loaded> poll();

  // Destroys a scene on the thread: freeing the memory of large meshes takes milliseconds.
  void release(std::unique_ptr<const Scene> scene);

 private:
  void run();

  const std::filesystem::path path_;
  UniqueFd ended_;  // an eventfd
  mutable std::mutex mutex_;
  std::condition_variable work_;
  bool requested_ = false;  // mutex_ guards this and the members below
  bool loading_ = false;
  bool stop_ = false;
  std::optional<Loaded> loaded_;
  std::unique_ptr<const Scene> discarded_;
  std::thread thread_;
};

}  // namespace buoyancy::service
