// Hydrostatic tables: the properties of a hull at given drafts and trims, upright.
//
// Points are coordinates along the ship's axes (ship_axes.h). Longitudinal ones are measured from midship, in
// the middle between the perpendiculars, positive forward; transverse ones from the centre plane, where the
// port coordinate of B is 0, positive to port; vertical ones from the keel K, positive up. The draft is that
// of the keel at midship, at right angles to the base line; the trim turns the water plane about the point on
// the water there, positive by the stern.
//
// BM is the second moment of the waterplane about an axis through the waterplane's own centroid, over the
// displaced volume: BMt about the forward axis in the waterplane, BMl about the axis across it. KM is the
// height of the metacentre, which lies BM above the centre of buoyancy along the vertical: KM = KB + BM cos
// trim.
#pragma once

#include <optional>
#include <vector>

#include "flotation/floating_body.h"
#include "flotation/ship_axes.h"

namespace buoyancy {

struct HydrostaticTableOptions {
  ShipAxes axes{};
  std::optional<double> keel{};  // [m], of K along up from B's origin; nullopt: the lowest vertex along up
  // [m], along forward from B's origin; nullopt: the ends of the meshes.
  std::optional<double> aft_perpendicular{}, forward_perpendicular{};
  // false: the mass of the body is any, and its centre unknown. MCT1cm and RM1deg, which need it, are NaN.
  bool knows_mass = true;
};

// Form coefficients on one length L, with the beam B of the waterplane and the draft T at midship.
struct FormCoefficients {
  double length = 0.0;      // [m], L
  double block = 0.0;       // Cb = V / (L B T)
  double prismatic = 0.0;   // Cp = V / (L A_m), A_m: the immersed section at midship
  double waterplane = 0.0;  // Cwp = A / (L B)
};

// Quotients whose divisor is 0 are NaN, and what depends on an unknown centre of mass. In layered water: what
// hydrostatics.h says about it; drafts are under the surface, and so are LWL, BWL and the section at midship.
struct HydrostaticRow {
  double draft = 0.0;              // [m]
  double trim = 0.0;               // [rad]
  double volume = 0.0;             // [m^3], displaced
  double mass = 0.0;               // [kg], displaced
  double lcb = 0.0;                // [m], centre of buoyancy, forward of midship
  double tcb = 0.0;                // [m], to port of the centre plane
  double kb = 0.0;                 // [m], over the keel
  double lcf = 0.0;                // [m], centroid of the waterplane, forward of midship
  double waterplane_area = 0.0;    // [m^2]
  double bm_t = 0.0;               // [m], about the longitudinal axis
  double bm_l = 0.0;               // [m], about the transverse axis
  double km_t = 0.0;               // [m], metacentre over the keel
  double km_l = 0.0;               // [m]
  double mass_per_cm = 0.0;        // [kg/cm], TPC: mass that immerses the hull by 1 cm
  double moment_per_cm = 0.0;      // [kg m/cm], MCT1cm: V rho GM_L / (100 Lpp)
  double moment_per_degree = 0.0;  // [kg m], RM1deg: V rho GM_T sin 1 degree
  double wetted_area = 0.0;        // [m^2], without the waterplane
  double lwl = 0.0;                // [m], length of the waterplane along the horizontal forward axis
  double bwl = 0.0;                // [m], its beam
  double midship_area = 0.0;       // [m^2], A_m
  double midship = 0.0;            // Cm = A_m / (B T)
  FormCoefficients on_lpp, on_lwl;
};

// A hull that is prepared for rows of a table. It is immutable: threads may request rows at once.
class HydrostaticTable {
 public:
  // Errors: perpendiculars that are not finite, or not aft before forward; a keel that is not finite. body:
  // outlives the table. Its centre of mass counts only in MCT1cm and RM1deg, and its mass only as a weight
  // beside the liquids in its tanks. Complexity: O(triangles).
  static Expected<HydrostaticTable> make(const FloatingBody& body, const Water& water,
                                         const HydrostaticTableOptions& options = {});

  // draft: [m]. trim: [rad], between -pi/2 and pi/2. Returns nullopt where the boundary of an open mesh is
  // under water, and where a number is beyond double's range. A pure function. Complexity: O(triangles that
  // the water cuts + log n + edges of the section at midship).
  std::optional<HydrostaticRow> row(double draft, double trim = 0.0) const;

  double keel() const { return keel_; }                          // [m], along up from B's origin
  double midship() const { return midship_; }                    // [m], along forward from B's origin
  double length_between_perpendiculars() const { return lpp_; }  // [m]
  bool knows_mass() const { return knows_mass_; }

 private:
  // An edge of the section at midship, with the hull to its left seen from forward: (port, up) in metres from
  // B's origin.
  struct SectionEdge {
    Eigen::Vector2d from, to;
    double signed_permeability = 1.0;  // of the mesh
  };

  HydrostaticTable(const FloatingBody& body, const Water& water) : body_(&body), water_(water) {}
  void cut_midship_section();
  double immersed_section(double draft) const;  // [m^2]

  const FloatingBody* body_;
  Water water_;
  ShipAxes axes_;
  double keel_ = 0.0;
  double midship_ = 0.0;
  double lpp_ = 0.0;
  bool knows_mass_ = true;
  double waterplane_tolerance_ = 0.0;  // [m^2], error bound of its area
  std::vector<SectionEdge> section_;
};

}  // namespace buoyancy
