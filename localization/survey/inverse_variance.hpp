#pragma once

#include <ceres/loss_function.h>

namespace lodestar {

/// Scales squared residuals by the inverse of a variance factor that may change.
class InverseVariance : public ceres::LossFunction {
 public:
  void set(double factor) { weight_ = 1.0 / factor; }
  [[nodiscard]] double weight() const { return weight_; }
  void Evaluate(double squares, double out[3]) const override {
    out[0] = weight_ * squares;
    out[1] = weight_;
    out[2] = 0.0;
  }

 private:
  double weight_ = 1.0;
};

}  // namespace lodestar
