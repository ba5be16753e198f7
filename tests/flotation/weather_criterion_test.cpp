#include "flotation/weather_criterion.h"

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "base/angles.h"
#include "tests/flotation/bodies.h"
#include "tests/flotation/box_section.h"

namespace buoyancy {
namespace {

// A ship whose factors are at nodes of the tables: B/d 2.5, Cb 0.6, no keels.
constexpr RollForm kForm{
    .length_wl = 100.0, .breadth = 15.0, .draft = 6.0, .block = 0.6, .kg = 6.0, .gm = 1.0};

TEST(RollToWindward, FollowsTheFormulaeOfTheCode) {
  const RollToWindward roll = roll_to_windward(kForm, {});
  const double c = 0.373 + 0.023 * 2.5 - 0.043;
  const double period = 2.0 * c * 15.0;  // 11.6 s, between 8 and 12 s
  const double s = 0.093 + (period - 8.0) / 4.0 * (0.065 - 0.093);
  EXPECT_NEAR(roll.c, c, 1e-15);
  EXPECT_NEAR(roll.period, period, 1e-12);
  EXPECT_NEAR(roll.s, s, 1e-15);
  EXPECT_NEAR(roll.r, 0.73, 1e-15);
  EXPECT_NEAR(roll.angle / kRadiansPerDegree, 109.0 * 0.98 * 0.95 * std::sqrt(0.73 * s), 1e-10);
  EXPECT_TRUE(roll.breadth_in_range && roll.kg_in_range && roll.period_in_range);
}

TEST(RollToWindward, InterpolatesTheTables) {
  const auto form_at = [](double breadth, double block) {
    RollForm form = kForm;
    form.breadth = breadth * form.draft;
    form.block = block;
    return form;
  };
  struct Row {
    double breadth, x1;
  };
  for (const Row& row : {Row{1.0, 1.0}, {2.4, 1.0}, {2.65, 0.955}, {3.3, 0.84}, {3.45, 0.81}, {5.0, 0.8}}) {
    EXPECT_NEAR(roll_to_windward(form_at(row.breadth, 0.6), {}).x1, row.x1, 1e-12) << row.breadth;
  }
  struct Block {
    double block, x2;
  };
  for (const Block& row : {Block{0.3, 0.75}, {0.475, 0.785}, {0.65, 0.97}, {0.9, 1.0}}) {
    EXPECT_NEAR(roll_to_windward(form_at(2.5, row.block), {}).x2, row.x2, 1e-12) << row.block;
  }
  struct Keel {
    double area, k;  // 15 m^2 are 1 percent of L B
  };
  for (const Keel& row :
       {Keel{0.0, 1.0}, {7.5, 0.99}, {30.0, 0.88}, {41.25, 0.765}, {60.0, 0.7}, {90.0, 0.7}}) {
    EXPECT_NEAR(roll_to_windward(kForm, {.bilge_keel_area = row.area}).k, row.k, 1e-12) << row.area;
  }
  EXPECT_EQ(roll_to_windward(kForm, {.sharp_bilges = true}).k, 0.7);
  struct Period {
    double period, s;
  };
  for (const Period& row : {Period{5.0, 0.1}, {6.5, 0.099}, {10.0, 0.079}, {17.0, 0.041}, {25.0, 0.035}}) {
    RollForm form = kForm;
    form.gm = std::pow(2.0 * 0.3875 * 15.0 / row.period, 2);
    EXPECT_NEAR(roll_to_windward(form, {}).s, row.s, 1e-12) << row.period;
  }
}

TEST(RollToWindward, SaysWhatIsOutsideTheDataOfTheCode) {
  RollForm form = kForm;
  form.breadth = 3.5 * form.draft;
  EXPECT_FALSE(roll_to_windward(form, {}).breadth_in_range);
  for (const double kg : {4.1, 9.1}) {
    form = kForm;
    form.kg = kg;
    EXPECT_FALSE(roll_to_windward(form, {}).kg_in_range) << kg;
  }
  form = kForm;
  form.gm = 0.3;
  EXPECT_FALSE(roll_to_windward(form, {}).period_in_range);
  form.gm = -0.1;
  EXPECT_EQ(roll_to_windward(form, {}).period, std::numeric_limits<double>::infinity());
}

// Returns the heel between two at which GZ is the lever, by bisection.
double heel_at(const BoxSection& box, double kg, double lever, double low, double high) {
  const bool rises = box.gz(high, kg) > lever;
  for (int round = 0; round < 60; ++round) {
    const double middle = 0.5 * (low + high);
    ((box.gz(middle, kg) < lever) == rises ? low : high) = middle;
  }
  return low;
}

class WeatherCriterionOfABox : public testing::Test {
 protected:
  std::optional<WeatherCriterion> at(double windage_area, const CriticalHeels& heels = {}) const {
    return weather_criterion(ship_.body, water_, {.windage_area = windage_area, .windage_lever = 8.0}, table_,
                             heels, {});
  }

  Water water_;
  BoxShip ship_;
  HydrostaticTable table_ = HydrostaticTable::make(ship_.body, water_).value();
  BoxSection box_{.beam = 20.0, .depth = 12.0, .draft = 6.0};
};

TEST_F(WeatherCriterionOfABox, AgreesWithAClippedRectangle) {
  constexpr double kKg = 8.0;
  const std::optional<WeatherCriterion> found = at(6000.0);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->form.draft, 6.0, 1e-9);
  EXPECT_NEAR(found->form.length_wl, 80.0, 1e-9);
  EXPECT_NEAR(found->form.breadth, 20.0, 1e-9);
  EXPECT_NEAR(found->form.block, 1.0, 1e-9);
  EXPECT_NEAR(found->form.kg, kKg, 1e-9);
  EXPECT_NEAR(found->form.gm, 3.0 + 400.0 / 72.0 - kKg, 1e-6);
  const double lw1 = 504.0 * 6000.0 * 8.0 / (water_.gravity * water_.density * 9600.0);
  EXPECT_NEAR(found->lw1, lw1, 1e-12);
  EXPECT_NEAR(found->lw2, 1.5 * lw1, 1e-12);

  const double phi0 = heel_at(box_, kKg, lw1, 0.0, 0.6);
  const double gust = heel_at(box_, kKg, 1.5 * lw1, 0.0, 0.6);
  EXPECT_NEAR(*found->steady_heel, phi0, 1e-9);
  EXPECT_NEAR(*found->gust_heel, gust, 1e-9);
  EXPECT_FALSE(found->second_intercept);
  const double end = 50.0 * kRadiansPerDegree;
  EXPECT_NEAR(found->end_heel, end, 1e-12);
  const double from = phi0 - found->roll.angle;
  EXPECT_NEAR(found->area_a, 1.5 * lw1 * (gust - from) - box_.area(from, gust, kKg), 1e-6);
  EXPECT_NEAR(found->area_b, box_.area(gust, end, kKg) - 1.5 * lw1 * (end - gust), 1e-5);
  EXPECT_TRUE(found->is_area_met());
  EXPECT_FALSE(found->is_steady_heel_met()) << phi0 / kRadiansPerDegree;
}

TEST_F(WeatherCriterionOfABox, EndsWhereWaterComesInOrTheArmFallsBelowTheGust) {
  const double flooding = 35.0 * kRadiansPerDegree;
  EXPECT_NEAR(at(6000.0, {.downflooding = flooding})->end_heel, flooding, 1e-12);
  const WeatherCriterion early = *at(6000.0, {.downflooding = 0.1});
  EXPECT_EQ(early.area_b, 0.0);
  EXPECT_FALSE(early.is_area_met());

  const WeatherCriterion strong = *at(11'000.0);
  const double lw2 = strong.lw2;
  ASSERT_TRUE(strong.second_intercept);
  EXPECT_NEAR(*strong.second_intercept, heel_at(box_, 8.0, lw2, 0.7, 50.0 * kRadiansPerDegree), 1e-9);
  EXPECT_EQ(strong.end_heel, *strong.second_intercept);

  const WeatherCriterion hopeless = *at(30'000.0);
  EXPECT_FALSE(hopeless.steady_heel);
  EXPECT_FALSE(hopeless.is_steady_heel_met() || hopeless.is_area_met());
}

TEST_F(WeatherCriterionOfABox, LimitsTheSteadyHeelByTheDeckEdge) {
  EXPECT_NEAR(at(600.0)->steady_limit, 16.0 * kRadiansPerDegree, 1e-15);
  EXPECT_NEAR(at(600.0, {.deck_edge = 0.2})->steady_limit, 0.16, 1e-15);
  EXPECT_TRUE(at(600.0)->is_steady_heel_met());
  EXPECT_FALSE(at(600.0, {.deck_edge = 0.05})->is_steady_heel_met());
}

}  // namespace
}  // namespace buoyancy
