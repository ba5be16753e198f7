#include "geometry/hole_closing.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

#include "geometry/boundary_loops.h"
#include "geometry/common_volume.h"
#include "geometry/enclosed_solid.h"
#include "geometry/loop_caps.h"
#include "geometry/mesh_orientation.h"
#include "geometry/mesh_repair.h"
#include "geometry/mesh_topology.h"
#include "geometry/swept_volume.h"

namespace buoyancy {
namespace {

constexpr std::size_t kMaxForLeastArea = 1'000;       // edges
constexpr double kMaxDoubtfulOverlap = 1e-2;          // of the volume
constexpr std::int64_t kClosingWork = 1'000'000'000;  // of caps of least area, each some 5 ns

// Returns a loop's area vector [m^2]. Over a hole it points outward if the normals of the mesh do.
Vec3 area_vector(const TriangleMesh& mesh, const Loop& loop) {
  const Vec3 origin = mesh.vertex(loop.front());
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < loop.size(); ++i)
    sum += (mesh.vertex(loop[i]) - origin).cross(mesh.vertex(loop[i + 1]) - origin);
  return 0.5 * sum;
}

double volume_under(const TriangleMesh& mesh, const std::vector<Triangle>& cap, const Vec3& origin) {
  double volume = 0.0;
  for (const Triangle& t : cap) {
    volume +=
        (mesh.vertex(t[0]) - origin).dot((mesh.vertex(t[1]) - origin).cross(mesh.vertex(t[2]) - origin)) /
        6.0;
  }
  return volume;
}

struct Cap {
  std::vector<Triangle> faces;
  double area = 0.0;          // [m^2]
  double disagreement = 0.0;  // [m^3]
};

Cap make_cap(const TriangleMesh& mesh, const Loop& loop, std::int64_t& work_left) {
  Vec3 mean = Vec3::Zero();
  for (const std::int32_t v : loop) mean += mesh.vertex(v) / static_cast<double>(loop.size());
  Cap cap;
  std::vector<Triangle> flat = cap_in_projection(mesh, loop);
  const double under_flat = volume_under(mesh, flat, mean);
  const auto n = static_cast<std::int64_t>(loop.size());
  double under_least = under_flat;
  cap.area = area_of(mesh, flat);
  if (loop.size() <= kMaxForLeastArea && n * n * n / 6 <= work_left) {
    cap.faces = cap_loop(mesh, loop, kMaxForLeastArea, work_left);
    under_least = volume_under(mesh, cap.faces, mean);
  }
  // All caps of a flat loop have the least area, but only ear clipping avoids folds and needles.
  constexpr double kEqual = 1e-9;
  const double least = cap.faces.empty() ? cap.area : area_of(mesh, cap.faces);
  if (cap.area <= least * (1.0 + kEqual)) {
    cap.faces = std::move(flat);
  } else {
    cap.area = least;
  }
  // The volume under the fan around the mean is 0, since volumes are taken about the mean.
  const auto [low, high] = std::minmax({0.0, under_flat, under_least});
  constexpr double kRounding = 1e-12;
  if (high - low > kRounding * bulge_of(cap.area)) cap.disagreement = high - low;
  return cap;
}

// Adds a wall along a rim and returns the loop at its top.
Loop raise_rim(TriangleMesh& mesh, const Loop& rim, const Vec3& height, RepairStep& step) {
  Loop top;
  for (const std::int32_t v : rim) top.push_back(mesh.add_vertex(mesh.vertex(v) + height));
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const std::size_t next = (i + 1) % rim.size();
    for (const Triangle& face :
         {Triangle{rim[i], rim[next], top[next]}, Triangle{rim[i], top[next], top[i]}}) {
      mesh.triangles.push_back(face);
      step.area += area_of_face(mesh, face);
    }
  }
  ++step.count;
  return top;
}

// Returns the loops of boundary edges, in the directions of caps over them, but none that ends at an edge of
// another kind.
std::vector<Loop> boundary_loops(const std::vector<Edge>& boundary) {
  std::vector<Edge> wanted;
  wanted.reserve(boundary.size());
  for (const auto& [from, to] : boundary) wanted.push_back({to, from});
  std::sort(wanted.begin(), wanted.end());
  std::vector<Loop> loops = find_loops(wanted);
  std::erase_if(loops, [&wanted](const Loop& loop) {
    return !std::binary_search(wanted.begin(), wanted.end(), Edge{loop.back(), loop.front()});
  });
  return loops;
}

double signed_volume_if_capped(const TriangleMesh& mesh) {
  const Vec3 center = bounding_box(mesh).center();
  double volume = volume_under(mesh, mesh.triangles, center);
  for (const Loop& loop : find_loops(missing_edges(mesh)))
    volume += volume_under(mesh, cap_in_projection(mesh, loop), center);
  return volume;
}

// Returns the volume [m^3] that counts more than once if some components, but not all, had to be flipped. An
// inner skin that crosses the outer one looks like a solid of its own; what it encloses would count twice
// instead of not at all.
double doubtful_overlap(TriangleMesh mesh) {
  const MeshTopology topology = mesh_topology(mesh);
  std::vector<ComponentReport> components = describe_components(mesh, topology);
  if (!orient_closed(mesh, topology, components)) return 0.0;
  const auto is_flipped = [](const ComponentReport& component) { return component.flipped; };
  const bool some = std::any_of(components.begin(), components.end(), is_flipped) &&
                    !std::all_of(components.begin(), components.end(), is_flipped);
  return some ? overlap_volume(mesh).value_or(std::numeric_limits<double>::infinity()) : 0.0;
}

// A copy of a mesh with closed holes, and what that took.
class Attempt {
 public:
  Attempt(const TriangleMesh& mesh, const ClosingOptions& options)
      : mesh_(mesh), options_(options), all_(options.holes || options.all_rims) {}

  void run(bool automatic) {
    const std::vector<Edge> boundary = mesh_topology(mesh_).boundary;
    if (!options_.rims.empty()) number_rims(boundary);
    const double outward = options_.freeboard > 0.0 && signed_volume_if_capped(mesh_) < 0.0 ? -1.0 : 1.0;
    close(boundary_loops(boundary), outward);
    if (automatic) repair();
    if (all_) close(find_loops(missing_edges(mesh_)), outward);
    if (automatic) repair();  // caps may lie on walls inside, which then bound nothing
    solid_ = enclosed_solid(mesh_);
    if (solid_ && solid_->volume > 0.0) doubtful_share_ = doubtful_overlap(mesh_) / solid_->volume;
  }

  // Returns why the result is not acceptable; nullopt if it is.
  std::optional<SkippedRepair> obstacle() const {
    const auto skipped = [this](RepairObstacle obstacle, double share) {
      return SkippedRepair{RepairKind::kCloseHoles, obstacle, holes_, share};
    };
    if (options_.freeboard > 0.0 && raised_ == 0) return skipped(RepairObstacle::kNoRim, 0.0);
    if (!solid_ || !(solid_->volume > 0.0)) return skipped(RepairObstacle::kStillOpen, 0.0);
    if (!(doubtful_share_ <= kMaxDoubtfulOverlap))
      return skipped(RepairObstacle::kSelfIntersection, doubtful_share_);
    const double bulge = bulge_of_holes_ / solid_->volume;
    if (!(bulge <= options_.max_change)) return skipped(RepairObstacle::kBulge, bulge);
    const double disagreement = report_.cap_disagreement / solid_->volume;
    if (!(disagreement <= std::min(options_.max_change, kMaxCapDisagreement)))
      return skipped(RepairObstacle::kDisagreement, disagreement);
    return std::nullopt;
  }

  const std::optional<EnclosedSolid>& solid() const { return solid_; }
  TriangleMesh& mesh() { return mesh_; }
  RepairReport& report() { return report_; }

 private:
  void repair() {
    if (needs_repair(mesh_topology(mesh_))) append(repair_mesh(mesh_, false), report_);
  }

  void number_rims(const std::vector<Edge>& boundary) {
    const std::vector<Hole> holes = find_holes(mesh_, boundary);
    for (std::size_t i = 0; i < holes.size(); ++i) {
      const auto number = static_cast<std::int32_t>(i) + 1;
      if (std::find(options_.rims.begin(), options_.rims.end(), number) == options_.rims.end()) continue;
      for (const Edge& edge : holes[i].edges) chosen_.insert(chosen_.end(), edge.begin(), edge.end());
    }
    std::sort(chosen_.begin(), chosen_.end());
  }

  bool faces_up(const Loop& loop, double outward) const {
    constexpr double kCosine = 0.5;
    const Vec3 area = outward * area_vector(mesh_, loop);
    return area.dot(options_.up_B) > kCosine * area.norm();
  }

  void close(std::vector<Loop> loops, double outward) {
    RepairStep walls;
    walls.kind = RepairKind::kRaiseRims;
    RepairStep caps;
    caps.kind = RepairKind::kCloseHoles;
    for (Loop& loop : loops) {
      bool is_rim = options_.all_rims || std::binary_search(chosen_.begin(), chosen_.end(), loop.front());
      if (options_.freeboard > 0.0 && faces_up(loop, outward)) {
        is_rim = true;
        ++raised_;
        loop = raise_rim(mesh_, loop, options_.freeboard * options_.up_B, walls);
      }
      if (!is_rim && !options_.holes) continue;
      const Cap cap = make_cap(mesh_, loop, work_left_);
      mesh_.triangles.insert(mesh_.triangles.end(), cap.faces.begin(), cap.faces.end());
      ++caps.count;
      caps.area += cap.area;
      report_.cap_bulge += bulge_of(cap.area);
      report_.cap_disagreement += cap.disagreement;
      if (!is_rim) bulge_of_holes_ += bulge_of(cap.area);
    }
    holes_ += caps.count;
    if (walls.count > 0) report_.steps.push_back(walls);
    if (caps.count == 0) return;
    caps.after = enclosed_solid(mesh_);
    report_.steps.push_back(caps);
  }

  TriangleMesh mesh_;
  const ClosingOptions& options_;
  bool all_;
  std::vector<std::int32_t> chosen_;  // vertices of the rims requested by number; ascending
  RepairReport report_;
  std::optional<EnclosedSolid> solid_;
  std::int64_t holes_ = 0;
  std::int64_t raised_ = 0;
  double bulge_of_holes_ = 0.0;  // [m^3], of holes that options_.max_change limits
  double doubtful_share_ = 0.0;  // of the volume
  std::int64_t work_left_ = kClosingWork;
};

}  // namespace

void close_holes(TriangleMesh& mesh, const ClosingOptions& options, bool automatic, RepairReport& report) {
  const MeshTopology topology = mesh_topology(mesh);
  if (options.empty() || topology.counts.all_matched()) return;
  if (is_soup(mesh, topology)) {
    const auto edges = static_cast<std::int64_t>(topology.boundary.size());
    report.skipped.push_back({RepairKind::kCloseHoles, RepairObstacle::kTooMany, edges});
    return;
  }
  Attempt attempt(mesh, options);
  attempt.run(automatic);
  if (const std::optional<SkippedRepair> obstacle = attempt.obstacle()) {
    report.skipped.push_back(*obstacle);
    return;
  }
  mesh = std::move(attempt.mesh());
  append(attempt.report(), report);
  report.skipped.clear();
}

std::optional<ClosingEstimate> estimate_closing(const TriangleMesh& mesh) {
  ClosingOptions all;
  all.all_rims = true;
  Attempt attempt(mesh, all);
  attempt.run(true);
  if (!attempt.solid() || !(attempt.solid()->volume > 0.0)) return std::nullopt;
  if (const auto obstacle = attempt.obstacle();
      obstacle && obstacle->obstacle == RepairObstacle::kSelfIntersection) {
    return std::nullopt;
  }
  return ClosingEstimate{attempt.solid()->volume, attempt.report().cap_bulge,
                         attempt.report().cap_disagreement};
}

}  // namespace buoyancy
