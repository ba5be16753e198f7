// The handles of the C interface, and a registry of those that exist.
//
// A call looks its handles up before it uses them, so that one that was freed, is of another kind or is no
// handle at all is an error and never a crash. A lookup takes about 30 ns.
#pragma once

#include <memory>
#include <utility>

#include "c/buoyancy.h"
#include "query/pose_evaluation.h"
#include "query/query_mesh.h"
#include "query/query_sea.h"
#include "scene/scene.h"

struct buoyancy_mesh {
  explicit buoyancy_mesh(std::shared_ptr<const buoyancy::QueryMesh> prepared) : mesh(std::move(prepared)) {}

  std::shared_ptr<const buoyancy::QueryMesh> mesh;
};

struct buoyancy_sea {
  explicit buoyancy_sea(buoyancy::QuerySea made) : sea(std::move(made)) {}

  buoyancy::QuerySea sea;
};

struct buoyancy_scene {
  buoyancy_scene(buoyancy::Scene prepared, const buoyancy::SeaDescription& description)
      : scene(std::move(prepared)), water(water_of(scene)), sea(description) {}

  buoyancy::Scene scene;
  buoyancy::QueryWater water;
  buoyancy::SeaDescription sea;
};

namespace buoyancy {

enum class HandleKind { kNone, kMesh, kSea, kScene };

template <typename Handle>
inline constexpr HandleKind kKindOf = HandleKind::kNone;
template <>
inline constexpr HandleKind kKindOf<buoyancy_mesh> = HandleKind::kMesh;
template <>
inline constexpr HandleKind kKindOf<buoyancy_sea> = HandleKind::kSea;
template <>
inline constexpr HandleKind kKindOf<buoyancy_scene> = HandleKind::kScene;

const char* to_string(HandleKind kind);  // "a mesh"

// Returns kNone if there is no handle with this address.
HandleKind kind_of(const void* handle);
void add_handle(const void* handle, HandleKind kind);
// Returns false, and does nothing, if there is no handle of this kind with this address.
bool remove_handle(const void* handle, HandleKind kind);

// Gives the caller a new handle.
template <typename Handle>
void hand_over(std::unique_ptr<Handle> handle, Handle** out) {
  add_handle(handle.get(), kKindOf<Handle>);
  *out = handle.release();
}

}  // namespace buoyancy
