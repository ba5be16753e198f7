// The result of a query: a wrench per pose, as arrays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "messages/loads.h"
#include "python/pose_input.h"
#include "query/pose_evaluation.h"

namespace buoyancy::python {

// All arrays lie in one allocation. The views that Python gets are made on demand, since making one takes
// longer than some queries.
class Wrenches {
 public:
  // single: Python sees (3,) rather than (1, 3). Values are not initialised.
  Wrenches(std::size_t poses, bool single);

  std::size_t size() const { return arrays_.statuses.size(); }
  bool single() const { return single_; }
  const WrenchArrays& arrays() const { return arrays_; }
  void set(std::size_t i, const BodyWrench& wrench);

  // The loads of a body that has them, one per pose; else empty. has_loads tells which if there are no poses.
  std::vector<BodyLoads> loads;
  bool has_loads = false;
  // Set for a response from the service only, with one id per body.
  std::vector<std::int32_t> body_ids;
  std::optional<std::int64_t> utime;

 private:
  bool single_;
  std::unique_ptr<std::byte[]> memory_;
  WrenchArrays arrays_;  // parts of the memory
};

// The Wrenches to fill: `out`, or a new one for nullptr and None. Throws where `out` has another shape.
py::object wrenches_for(PyObject* out, std::size_t poses, bool single);

// Evaluates the poses without the global interpreter lock. with_loads: sets the loads as well.
py::object evaluate(const Body& body, const QueryWater& water, const PoseInput& poses, bool with_loads,
                    unsigned threads, PyObject* out);

// An array per field of BodyHydrostatics.
py::object evaluate_hydrostatics(const Body& body, const Water& water, const PoseInput& poses,
                                 unsigned threads);

// A number of threads that a caller passes; 0 if it was left out.
unsigned to_threads(PyObject* threads);

void define_wrenches(py::module_& module);

}  // namespace buoyancy::python
