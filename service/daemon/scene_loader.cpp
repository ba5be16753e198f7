#include "service/daemon/scene_loader.h"

#include <exception>
#include <new>
#include <string>
#include <utility>

#include <sys/eventfd.h>
#include <unistd.h>

namespace buoyancy::service {
namespace {

SceneLoader::Loaded load(const std::filesystem::path& path) {
  try {
    Expected<Scene> scene = Scene::load(path);
    if (!scene) return tl::unexpected(std::move(scene.error()));
    return std::make_unique<const Scene>(std::move(*scene));
  } catch (const std::bad_alloc&) {
    return tl::unexpected(out_of_memory_for(path.string()));
  } catch (const std::exception& exception) {  // whatever a file makes a library do, the service goes on
    return make_error({path.string(), std::string("the scene could not be loaded: ") + exception.what(),
                       "a scene that buoyancyd --check accepts", "", ""});
  }
}

}  // namespace

Error out_of_memory_for(const std::string& scene) {
  return {scene, "out of memory while loading it",
          "enough memory for two scenes: the current one is served until the new one is ready", "",
          "Restart the service with the new scene, or give it more memory"};
}

SceneLoader::SceneLoader(std::filesystem::path path)
    : path_(std::move(path)), ended_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)), thread_([this] { run(); }) {}

SceneLoader::~SceneLoader() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  work_.notify_one();
  thread_.join();
}

void SceneLoader::request() {
  {
    const std::lock_guard lock(mutex_);
    requested_ = true;
  }
  work_.notify_one();
}

bool SceneLoader::is_loading() const {
  const std::lock_guard lock(mutex_);
  return requested_ || loading_;
}

std::optional<SceneLoader::Loaded> SceneLoader::poll() {
  const std::lock_guard lock(mutex_);
  ::eventfd_t finished_loads = 0;
  ::eventfd_read(ended_.value(), &finished_loads);
  return std::exchange(loaded_, std::nullopt);
}

void SceneLoader::release(std::unique_ptr<const Scene> scene) {
  {
    const std::lock_guard lock(mutex_);
    discarded_.swap(scene);
  }
  work_.notify_one();
}

void SceneLoader::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    work_.wait(lock, [this] { return requested_ || stop_ || discarded_ != nullptr; });
    if (std::unique_ptr<const Scene> scene = std::move(discarded_)) {
      lock.unlock();
      scene.reset();
      lock.lock();
    }
    if (stop_) return;
    if (!std::exchange(requested_, false)) continue;
    loading_ = true;
    lock.unlock();
    std::optional<Loaded> loaded(load(path_));
    lock.lock();
    loading_ = false;
    loaded_.swap(loaded);
    ::eventfd_write(ended_.value(), 1);
    lock.unlock();
    loaded.reset();  // an earlier result that poll() did not fetch
    lock.lock();
  }
}

}  // namespace buoyancy::service
