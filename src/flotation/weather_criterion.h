// Severe wind and rolling: the weather criterion of the 2008 IS Code, part A, 2.3. Data, not an approval by a
// class.
//
// A steady beam wind heels the ship to starboard by phi0. Waves roll it back to windward by phi1, where a
// gust meets it. The area b, in which the righting arm is above the lever of the gust, up to phi2, must not
// be less than the area a, in which it is below, from phi0 - phi1 on. Symbols are those of the code.
#pragma once

#include <limits>
#include <optional>

#include "flotation/hydrostatic_table.h"
#include "flotation/righting_arms.h"

namespace buoyancy {

// What the geometry under water does not say.
struct WeatherExposure {
  double windage_area = 0.0;     // [m^2], A: lateral area of ship and deck cargo over the water
  double windage_lever = 0.0;    // [m], Z: from the centre of A down to that of the lateral area under water
  double wind_pressure = 504.0;  // [Pa], P
  double bilge_keel_area = 0.0;  // [m^2], A_k: of bilge keels and the lateral projection of a bar keel
  bool sharp_bilges = false;
};

// What the roll to windward depends on.
struct RollForm {
  double length_wl = 0.0;  // [m], Lwl
  double breadth = 0.0;    // [m], B, of the waterplane
  double draft = 0.0;      // [m], d, at midship
  double block = 0.0;      // Cb, on Lwl
  double kg = 0.0;         // [m], KG, with the liquids in tanks
  double gm = 0.0;         // [m], GM, with their free surfaces
};

struct RollToWindward {
  double x1 = 0.0, x2 = 0.0, k = 0.0, s = 0.0;  // factors, interpolated in the tables; their ends beyond
  double r = 0.0;                               // 0.73 + 0.6 OG / d, not below 0
  double c = 0.0;                               // C of the rolling period
  double period = 0.0;                          // [s], T; infinite unless GM is above 0
  double angle = 0.0;                           // [rad], phi1
  // Is the ship within the data of the formulae: B/d < 3.5, -0.3 <= KG/d - 1 <= 0.5, T < 20 s?
  bool breadth_in_range = true, kg_in_range = true, period_in_range = true;
};

// form: numbers above 0, but for KG and GM. Complexity: O(1).
RollToWindward roll_to_windward(const RollForm& form, const WeatherExposure& exposure);

struct WeatherCriterion {
  RollForm form;
  RollToWindward roll;
  double lw1 = 0.0, lw2 = 0.0;  // [m], levers of the steady wind and of the gust
  // [rad]. nullopt: no arm up to 50 degrees reaches the lever.
  std::optional<double> steady_heel = {};       // phi0
  std::optional<double> gust_heel = {};         // where the arm rises to lw2
  std::optional<double> second_intercept = {};  // phi_c, where it falls below lw2; nullopt: beyond 50 degrees
  double steady_limit = 0.0;                    // [rad], 16 degrees or 80 % of the immersion of the deck edge
  double end_heel = 0.0;                        // [rad], phi2; 0 without gust_heel
  double area_a = 0.0, area_b = 0.0;            // [m rad]; 0 without gust_heel

  bool is_steady_heel_met() const { return steady_heel && *steady_heel <= steady_limit; }
  bool is_area_met() const { return gust_heel && end_heel > *gust_heel && area_b >= area_a; }
};

// [rad], to starboard; infinity: not known.
struct CriticalHeels {
  double deck_edge = std::numeric_limits<double>::infinity();
  double downflooding = std::numeric_limits<double>::infinity();
};

// table: of the same body. Returns nullopt where a righting arm that it needs, at heels from the roll to
// windward to 50 degrees, has no result, and where the upright body has no waterplane. Complexity: some 300
// righting arms.
std::optional<WeatherCriterion> weather_criterion(const FloatingBody& body, const Water& water,
                                                  const WeatherExposure& exposure,
                                                  const HydrostaticTable& table, const CriticalHeels& heels,
                                                  const RightingArmOptions& options);

}  // namespace buoyancy
