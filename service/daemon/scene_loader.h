// Loads a scene anew on a thread of its own while the service goes on answering from the one it has: meshes
// may take seconds, and a request does not wait for them.
//
// The law: after a request a load begins that sees the files as they are then or later. A request that comes
// while a load is under way is answered by one more load after it, however many requests there were. What a
// load brought waits in poll(); a newer one replaces what nobody took. Nothing else is shared with the
// thread, and a loaded scene is handed over whole.
#pragma once

#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "base/error.h"
#include "base/unique_fd.h"
#include "scene/scene.h"

namespace buoyancy {

class SceneLoader {
 public:
  using Loaded = Expected<std::unique_ptr<const Scene>>;

  // The scene file. Starts the thread, which inherits the caller's signal mask.
  explicit SceneLoader(std::filesystem::path path);
  SceneLoader(const SceneLoader&) = delete;
  SceneLoader& operator=(const SceneLoader&) = delete;
  // Waits for the load under way, which may take as long as the scene's limits allow: a program that ends
  // asks is_loading() and ends without.
  ~SceneLoader();

  void request();           // returns at once
  bool is_loading() const;  // is a load under way or about to begin?

  // Readable when poll() has something: for poll(). Negative: the system gave no descriptor.
  int fileno() const { return ended_.value(); }
  // The scene of the load that ended, or why there is none; nullopt: none has ended since the last call.
  // std::bad_alloc of the load is such a reason.
  std::optional<Loaded> poll();

  // Frees a scene on the thread: the memory of large meshes takes milliseconds to give back.
  void release(std::unique_ptr<const Scene> scene);

 private:
  void run();

  const std::filesystem::path path_;
  UniqueFd ended_;  // an eventfd
  mutable std::mutex mutex_;
  std::condition_variable work_;
  bool requested_ = false;  // as are all below: under mutex_
  bool loading_ = false;
  bool stop_ = false;
  std::optional<Loaded> loaded_;
  std::unique_ptr<const Scene> discarded_;
  std::thread thread_;
};

}  // namespace buoyancy
