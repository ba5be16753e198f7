// Hears an LCM bus over UDP multicast without being woken by it: packets wait in the kernel, stamped with the
// time of their arrival, until somebody comes to take them.
//
// liblcm has a thread of its own that every packet wakes, and stamps a packet when that thread comes to read
// it. Both are wrong here: a wake-up is paid for by the process that sends, which is the one to be looked at,
// and times taken late are not the bus's.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "geometry/error.h"
#include "recording/file_descriptor.h"
#include "view/lcm_packets.h"

namespace buoyancy {

class BusListener {
 public:
  // channel: the index of its name; arrived: us since 1970.
  using Handler = std::function<void(std::size_t channel, Bytes payload, std::int64_t arrived)>;

  // url: as LcmConnection::open has it. Errors: no multicast (at once, or after 2 s), memq://, which is no
  // network.
  static Expected<BusListener> open(const std::string& url, std::vector<std::string> channels);

  // Hands over messages until none waits or `most` packets were looked at.
  void take_in(int most, const Handler& handler);

  std::int64_t packets_dropped() const {
    return packets_dropped_;
  }  // by the kernel: they came faster than taken
  std::int64_t fragments_dropped() const { return packets_.fragments_dropped(); }

 private:
  BusListener(FileDescriptor socket, std::vector<std::string> channels);

  FileDescriptor socket_;
  LcmPackets packets_;
  std::vector<std::uint8_t> packet_;  // reused
  std::int64_t packets_dropped_ = 0;
  std::uint32_t kernel_drops_ = 0;  // as the kernel said last; it wraps around
};

}  // namespace buoyancy
