// Reads the bytes of a request, and writes those of a response, in place and body by body: large requests are
// not copied into core types first, and several threads may share one message.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <tl/expected.hpp>

#include "messages/request.h"
#include "messages/wire.h"
#include "messages/wire_layout.h"

namespace buoyancy {

// Size [bytes] of a body, a point or a sample in a message.
template <typename Element>
std::size_t encoded_element_size() {
  const Element element;
  LayoutSize layout;
  visit_fields(element, layout);
  return layout.size();
}

class RequestView {
 public:
  // Makes the checks of decode(). bytes must outlive the view. O(1).
  static tl::expected<RequestView, DecodeError> of(Bytes bytes);

  const RequestId& id() const { return id_; }
  double lead_time() const { return lead_time_; }  // [s]
  std::size_t size() const { return size_; }       // number of bodies

  // Precondition: i < size().
  BodyState body(std::size_t i) const {
    assert(i < size_);
    BodyState state;
    BigEndianReader reader(bodies_ + i * body_size_);
    visit_fields(state, reader);
    return state;
  }

  // Returns body(i).body_id and reads nothing else.
  std::int32_t body_id(std::size_t i) const {
    assert(i < size_);
    std::int32_t id = 0;
    BigEndianReader reader(bodies_ + i * body_size_);
    reader(id);
    return id;
  }

 private:
  RequestView() = default;

  RequestId id_;
  double lead_time_ = 0.0;
  std::size_t size_ = 0;
  std::size_t body_size_ = encoded_element_size<BodyState>();
  const std::uint8_t* bodies_ = nullptr;
};

class WaterPointsView {
 public:
  // Makes the checks of decode(). bytes must outlive the view. O(1).
  static tl::expected<WaterPointsView, DecodeError> of(Bytes bytes);

  std::size_t size() const { return size_; }  // number of points

  // Precondition: i < size().
  WaterPoint point(std::size_t i) const {
    assert(i < size_);
    WaterPoint point;
    BigEndianReader reader(points_ + i * sizeof(point));
    visit_fields(point, reader);
    return point;
  }

 private:
  WaterPointsView(const std::uint8_t* points, std::size_t size) : points_(points), size_(size) {}

  const std::uint8_t* points_;
  std::size_t size_;
};

// Message: WrenchResponse, BodiesHydrostatics or BodiesLoads.
template <typename Message>
class BodiesWriter {
 public:
  using Body = typename decltype(Message::bodies)::value_type;

  BodiesWriter() = default;  // of no message
  // Replaces bytes by a message with this number of bodies, all of which must be set; no heap allocation
  // once its capacity suffices. bytes must outlive the writer.
  BodiesWriter(const RequestId& id, std::size_t bodies, std::vector<std::uint8_t>& bytes);
  // Continues a message that another writer has begun.
  explicit BodiesWriter(std::vector<std::uint8_t>& begun);

  std::size_t size() const { return size_; }  // number of bodies

  // Several threads may set different bodies at once. Precondition: i < size().
  void set(std::size_t i, const Body& body) {
    assert(i < size_);
    BigEndianWriter writer(bodies_ + i * body_size_);
    visit_fields(body, writer);
  }

  // Precondition: i < size(), and body i has been set.
  Body body(std::size_t i) const {
    assert(i < size_);
    Body body;
    BigEndianReader reader(bodies_ + i * body_size_);
    visit_fields(body, reader);
    return body;
  }

 private:
  std::size_t size_ = 0;
  std::size_t body_size_ = encoded_element_size<Body>();
  std::uint8_t* bodies_ = nullptr;
};
using ResponseWriter = BodiesWriter<WrenchResponse>;

class WaterSamplesWriter {
 public:
  // Replaces bytes by a message of status kOk with this number of samples, all of which must be set; no heap
  // allocation once its capacity suffices. bytes must outlive the writer.
  WaterSamplesWriter(const RequestId& id, std::size_t samples, std::vector<std::uint8_t>& bytes);
  // Continues a message that another writer has begun.
  explicit WaterSamplesWriter(std::vector<std::uint8_t>& begun);

  // Several threads may set different samples at once. Precondition: i < size().
  void set(std::size_t i, const WaterSample& sample) {
    assert(i < size_);
    ArrayFields<BigEndianWriter, std::uint8_t> writer(samples_, size_, i);
    visit_fields(sample, writer);
  }

  // Sets the status, and all samples to 0.
  void fail(BodyStatus status);

 private:
  std::size_t size_;  // number of samples
  std::uint8_t* samples_;
};

}  // namespace buoyancy
