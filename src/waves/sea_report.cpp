#include "waves/sea_report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <variant>

#include "base/format.h"
#include "waves/dispersion.h"
#include "waves/wave_spectrum.h"

namespace buoyancy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTurn = 2.0 * std::numbers::pi;

double moment(std::span<const WaveComponent> components, int n) {
  double sum = 0.0;
  for (const WaveComponent& component : components) {
    sum += 0.5 * component.amplitude * component.amplitude * std::pow(component.angular_frequency, n);
  }
  return sum;
}

double peak_period_of(std::span<const WaveComponent> components) {
  const double energy = moment(components, 0);
  return kTurn * (moment(components, -2) / energy) * (moment(components, 1) / energy);
}

// Returns the tighter of two limits of a height [m]. An infinite depth limits nothing.
Breaking nearest(double height, double by_steepness, std::string_view steepness, double by_depth,
                 std::string_view depth) {
  return by_depth < by_steepness ? Breaking{height, by_depth, depth}
                                 : Breaking{height, by_steepness, steepness};
}

// Sources: R. Miche, "Mouvements ondulatoires de la mer en profondeur constante ou decroissante", 1944;
// DNV-RP-C205, "Environmental conditions and environmental loads", sections 3.4.6 and 3.5.4; E. B. Thornton
// and R. T. Guza, "Energy saturation and phase speeds measured on a natural beach", Journal of Geophysical
// Research 87 (1982), whose saturated root mean square height of 0.42 depths is a significant one of 0.6.
Breaking breaking_of_regular(double height, double angular_frequency, const Sea& sea) {
  const double k = wave_number(angular_frequency, sea.water().gravity, sea.depth());
  const double tanh_kd = std::isinf(sea.depth()) ? 1.0 : std::tanh(k * sea.depth());
  return nearest(height, 0.142 * (kTurn / k) * tanh_kd,
                 "0.142 lambda tanh(k depth) (Miche 1944, DNV-RP-C205)", 0.78 * sea.depth(),
                 "0.78 of the depth (DNV-RP-C205)");
}
Breaking breaking_of_irregular(double significant_wave_height, double peak_period, const Sea& sea) {
  const double between = std::clamp((peak_period - 8.0) / (15.0 - 8.0), 0.0, 1.0);
  const double steepness = std::lerp(1.0 / 15.0, 1.0 / 25.0, between);
  return nearest(significant_wave_height, steepness * sea.water().gravity * peak_period * peak_period / kTurn,
                 "Hs where 2 pi Hs / (g Tp^2) is 1/15 up to Tp = 8 s and 1/25 from 15 s on (DNV-RP-C205)",
                 0.6 * sea.depth(), "Hs of 0.6 of the depth (Thornton and Guza 1982)");
}

// Each component may break, and so may the sum of several: the one nearest to its limit is reported.
Breaking breaking_of_components(std::span<const WaveComponent> components, const WaveSystemReport& report,
                                const Sea& sea) {
  std::optional<Breaking> worst;
  const auto add = [&worst](const Breaking& other) {
    if (!worst || other.height * worst->limit > worst->height * other.limit) worst = other;
  };
  for (const WaveComponent& wave : components) {
    add(breaking_of_regular(2.0 * wave.amplitude, wave.angular_frequency, sea));
  }
  if (components.size() > 1) {
    add(breaking_of_irregular(report.significant_wave_height, report.peak->period, sea));
  }
  return *worst;
}

// Reports what follows from the components alone.
WaveSystemReport report_as_components(std::span<const WaveComponent> components, const Sea& sea) {
  WaveSystemReport report;
  report.type = "components";
  report.components = components.size();
  report.m0 = moment(components, 0);
  report.m1 = moment(components, 1);
  report.m2 = moment(components, 2);
  report.height = report.significant_wave_height = 4.0 * std::sqrt(report.m0);
  if (!(report.m0 > 0.0)) return report;
  report.zero_crossing_period = kTurn * std::sqrt(report.m0 / report.m2);
  report.peak.emplace().period = peak_period_of(components);
  report.breaking = breaking_of_components(components, report, sea);
  return report;
}

WaveSystemReport report_system(const WaveSystem& system, std::span<const WaveComponent> components,
                               const Sea& sea) {
  WaveSystemReport report = report_as_components(components, sea);
  if (const auto* regular = std::get_if<RegularWave>(&system)) {
    report.type = "regular";
    report.height = regular->height;
    report.peak.emplace().period = regular->period;
    report.breaking = breaking_of_regular(regular->height, kTurn / regular->period, sea);
  } else if (const auto* waves = std::get_if<IrregularWaves>(&system)) {
    report.type = waves->gamma == 1.0 ? "pierson_moskowitz" : "jonswap";
    report.gamma = gamma_of(*waves);
    report.gamma_is_default = !waves->gamma;
    report.peak.emplace().period = waves->peak_period;
    report.breaking = breaking_of_irregular(report.height, waves->peak_period, sea);
  }
  return report;
}

WaveSystemReport with_wavelength(WaveSystemReport report, const Sea& sea) {
  if (!report.peak) return report;
  PeakWave& peak = *report.peak;
  peak.wavelength = kTurn / wave_number(kTurn / peak.period, sea.water().gravity, sea.depth());
  peak.steepness = report.height / peak.wavelength;
  return report;
}

std::optional<Warning> breaking_warning(const std::string& subject, const WaveSystemReport& report) {
  if (!report.breaking || report.breaking->height < report.breaking->limit) return std::nullopt;
  return Warning{
      subject, format_text("a wave height of {:4} m", report.breaking->height),
      format_text("less than {:4} m, at which such waves break: {}", report.breaking->limit,
                  report.breaking->criterion),
      "a height that does not belong to the period or to the depth, or one in feet",
      "Use lower or longer waves, or deeper water: breaking is not modelled, and linear waves of this "
      "height are like none in nature"};
}

}  // namespace

std::vector<WaveSystemReport> report_wave_systems(const SeaDescription& description, const Sea& sea) {
  std::vector<WaveSystemReport> reports;
  std::span<const WaveComponent> rest = sea.components();
  for (const WaveSystem& system : description.systems) {
    const std::size_t count = number_of_components(system);
    reports.push_back(with_wavelength(report_system(system, rest.first(count), sea), sea));
    rest = rest.subspan(count);
  }
  return reports;
}

WaveSystemReport report_components(const Sea& sea) {
  return with_wavelength(report_as_components(sea.components(), sea), sea);
}

double repeat_time(std::span<const WaveComponent> components) {
  const double m0 = moment(components, 0);
  if (!(m0 > 0.0)) return kInfinity;
  const double mean = moment(components, 1) / m0;  // [rad/s]
  const double variance = moment(components, 2) / m0 - mean * mean;
  const double period = kTurn / mean;
  // The step is a quarter of the time in which components part by a radian, or at least a 25th of the period.
  const double step = 0.25 / std::sqrt(std::clamp(variance, 1e-12 * mean * mean, mean * mean));
  // Each component's exp(i (w - mean) t) times its share of the energy, and its rotation over a step.
  std::vector<double> re, im, step_cos, step_sin;
  for (const WaveComponent& component : components) {
    const double turn = (component.angular_frequency - mean) * step;
    re.push_back(0.5 * component.amplitude * component.amplitude / m0);
    im.push_back(0.0);
    step_cos.push_back(std::cos(turn));
    step_sin.push_back(std::sin(turn));
  }
  bool decayed = false;
  for (double t = step; t <= kRepeatSearch * period; t += step) {
    double cosine = 0.0;
    double sine = 0.0;
    for (std::size_t i = 0; i < re.size(); ++i) {
      const double next = re[i] * step_cos[i] - im[i] * step_sin[i];
      im[i] = re[i] * step_sin[i] + im[i] * step_cos[i];
      re[i] = next;
      cosine += next;
      sine += im[i];
    }
    const bool alike = std::hypot(cosine, sine) > kRepeatCorrelation;
    if (decayed && alike) return t;
    decayed = decayed || !alike;
  }
  return decayed ? kInfinity : period;
}

std::vector<Warning> sea_warnings(const std::string& subject, const Sea& sea,
                                  std::span<const WaveSystemReport> systems) {
  std::vector<Warning> warnings;
  const auto add = [&warnings](std::optional<Warning> warning) {
    if (warning) warnings.push_back(*std::move(warning));
  };
  if (sea.is_too_steep()) {
    warnings.push_back(
        {subject + ": the sea",
         format_text("a steepness of {:4} (4 sqrt(sum (a k)^2 / 2), or sum a k where that is less)",
                     sea.extreme_steepness()),
         "less than 1: under the steepest crests the modelled pressure falls downwards, since linear theory "
         "does not hold there",
         "waves too high for their length, or the short waves of a spectrum with a high cutoff",
         "Use lower or longer waves, or a lower cutoff"});
  }
  for (std::size_t i = 0; i < systems.size(); ++i) {
    add(breaking_warning(subject + ": wave system " + std::to_string(i + 1), systems[i]));
  }
  if (systems.size() != 1) add(breaking_warning(subject + ": the sea", report_components(sea)));
  return warnings;
}

}  // namespace buoyancy
