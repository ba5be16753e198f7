// Random messages for property tests: any bit pattern in every number, NaN and infinities included.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <limits>

#include <rapidcheck.h>

#include "messages/wire_layout.h"

namespace buoyancy {

template <typename Integer>
Integer random_integer() {
  using Limits = std::numeric_limits<Integer>;
  return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange<Integer>(Limits::min(), Limits::max()));
}

// Sets every field that it visits.
class Randomiser {
 public:
  template <typename... Fields>
  void operator()(Fields&... fields) {
    (randomise(fields), ...);
  }

 private:
  template <typename T>
  void randomise(T& field) {
    field = std::bit_cast<T>(random_integer<UnsignedOf<T>>());
  }
  template <typename T, std::size_t kSize>
  void randomise(std::array<T, kSize>& fields) {
    for (T& field : fields) randomise(field);
  }
};

// Of up to five bodies.
template <typename Message>
Message random_message() {
  Message message;
  Randomiser randomiser;
  visit_header(message, randomiser);
  message.bodies.resize(*rc::gen::inRange<std::size_t>(0, 6));
  for (auto& body : message.bodies) visit_fields(body, randomiser);
  return message;
}

}  // namespace buoyancy
