// Measures the period of a heave motion, to compare a run with the closed form of docs/loads.md.
#pragma once

#include <optional>

class HeavePeriod {
 public:
  // Call this in every step. time: [s]; velocity: [m/s], upwards.
  void add(double time, double velocity) {
    if (last_ && last_->velocity > 0.0 && velocity <= 0.0) {
      const double fraction = last_->velocity / (last_->velocity - velocity);
      const double top = last_->time + fraction * (time - last_->time);
      if (!first_top_) first_top_ = top;
      last_top_ = top;
      ++tops_;
    }
    last_ = {time, velocity};
  }

  // Returns the mean period [s] from the first to the last maximum of the height; nullopt: fewer than two.
  std::optional<double> mean() const {
    if (tops_ < 2) return std::nullopt;
    return (last_top_ - *first_top_) / (tops_ - 1);
  }

 private:
  struct Sample {
    double time, velocity;
  };
  std::optional<Sample> last_;
  std::optional<double> first_top_;
  double last_top_ = 0.0;
  int tops_ = 0;
};
