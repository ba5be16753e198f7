// Distributes the latest snapshot from one thread to many. Each text is made once and shared by all
// listeners. The publisher never waits for a slow listener, which receives the latest snapshot next and
// misses those in between.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

namespace buoyancy::view {

class SnapshotBroadcaster {
 public:
  using Text = std::shared_ptr<const std::string>;
  struct Published {
    std::int64_t number = 0;  // 0: nothing published yet
    Text history, snapshot;
    Text sea;  // nullptr: none, or that of the scene
  };

  // A listener is admitted if there are fewer than max_listeners.
  class Listener {
   public:
    Listener(SnapshotBroadcaster& broadcaster, int max_listeners);
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;
    ~Listener();
    bool admitted() const { return admitted_; }
    // Waits for a snapshot that this listener has not received yet. number 0: closed.
    Published next();

   private:
    SnapshotBroadcaster& broadcaster_;
    bool admitted_;
    std::int64_t received_ = 0;
  };

  // sea: sent to a listener before the snapshot if it is another object than the one that it received last.
  void publish(std::string history, std::string snapshot, Text sea = nullptr);
  int listeners() const;
  void close();  // every next() returns, now and later

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Published latest_;
  int listeners_ = 0;
  bool closed_ = false;
};

}  // namespace buoyancy::view
