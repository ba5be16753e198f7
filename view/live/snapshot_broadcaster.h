// Where one thread lays down the newest texts and many take them: each text is made once and shared by all
// who wait. Nobody waits for a slow taker: it gets the newest when it comes again, and what lay between is
// gone.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

namespace buoyancy {

class SnapshotBroadcaster {
 public:
  using Text = std::shared_ptr<const std::string>;
  struct Published {
    std::int64_t number = 0;  // 0: nothing yet
    Text history, snapshot;
  };

  // Somebody who takes. At most `most` at a time.
  class Listener {
   public:
    Listener(SnapshotBroadcaster& hub, int most);
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;
    ~Listener();
    bool admitted() const { return admitted_; }
    // Waits for texts that this listener has not got. number 0: closed.
    Published next();

   private:
    SnapshotBroadcaster& hub_;
    bool admitted_;
    std::int64_t seen_ = 0;
  };

  void publish(std::string history, std::string snapshot);
  int listeners() const;
  void close();  // every next() returns, now and from here on

 private:
  mutable std::mutex mutex_;
  std::condition_variable published_anew_;
  Published newest_;
  int listeners_ = 0;
  bool closed_ = false;
};

}  // namespace buoyancy
