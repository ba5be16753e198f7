#include "waves/sea_report.h"

#include <cmath>
#include <numbers>
#include <span>
#include <variant>

#include "waves/dispersion.h"
#include "waves/wave_spectrum.h"

namespace buoyancy {
namespace {

double moment(std::span<const WaveComponent> components, int n) {
  double sum = 0.0;
  for (const WaveComponent& component : components) {
    sum += 0.5 * component.amplitude * component.amplitude * std::pow(component.angular_frequency, n);
  }
  return sum;
}

// Returns nullopt without energy.
std::optional<double> calculated_peak_period(std::span<const WaveComponent> components) {
  const double energy = moment(components, 0);
  if (!(energy > 0.0)) return std::nullopt;
  return 2.0 * std::numbers::pi * (moment(components, -2) / energy) * (moment(components, 1) / energy);
}

WaveSystemReport report_system(const WaveSystem& system, std::span<const WaveComponent> components,
                               const Sea& sea) {
  WaveSystemReport report;
  report.components = components.size();
  report.significant_wave_height = 4.0 * std::sqrt(moment(components, 0));
  report.height = report.significant_wave_height;
  std::optional<double> period;
  if (const auto* regular = std::get_if<RegularWave>(&system)) {
    report.type = "regular";
    report.height = regular->height;
    period = regular->period;
  } else if (const auto* waves = std::get_if<IrregularWaves>(&system)) {
    report.type = waves->gamma == 1.0 ? "pierson_moskowitz" : "jonswap";
    report.gamma = gamma_of(*waves);
    report.gamma_is_default = !waves->gamma;
    period = waves->peak_period;
  } else {
    report.type = "components";
    period = calculated_peak_period(components);
  }
  if (period) {
    const double turn = 2.0 * std::numbers::pi;
    const double wavelength = turn / wave_number(turn / *period, sea.water().gravity, sea.depth());
    report.peak = PeakWave{*period, wavelength, report.height / wavelength};
  }
  return report;
}

}  // namespace

std::vector<WaveSystemReport> report_wave_systems(const SeaDescription& description, const Sea& sea) {
  std::vector<WaveSystemReport> reports;
  std::span<const WaveComponent> rest = sea.components();
  for (const WaveSystem& system : description.systems) {
    const std::size_t count = number_of_components(system);
    reports.push_back(report_system(system, rest.first(count), sea));
    rest = rest.subspan(count);
  }
  return reports;
}

}  // namespace buoyancy
