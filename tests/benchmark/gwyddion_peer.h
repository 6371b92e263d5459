#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "forward/surface/height_field.h"

namespace mezzotint::benchmark {

/// A height field in the hands of Gwyddion's library, on one thread: the peer that measurement is raced against. Never
/// a dependency: built only where libgwyddion is found.
///
/// Units   numbers are micrometres on both axes and in height; its own files say metres.
/// Frame   rows as ours; its picture is upside down then, which none of the steps minds.
class GwyddionField {
public:
  explicit GwyddionField(const HeightField& field);
  explicit GwyddionField(const std::filesystem::path& path);
  GwyddionField(const GwyddionField& other);
  GwyddionField& operator=(const GwyddionField&) = delete;
  ~GwyddionField();

  [[nodiscard]] double value(std::size_t index) const;
  [[nodiscard]] std::size_t masked() const;

  void mask_outliers(double k);  ///< adds to the mask
  void fill();                   ///< under the mask, which is empty afterwards
  /// The steps that its module "Flatten Base" is known for: a plane, then for degrees 2 to 5 a Gaussian through the
  /// peak of the height distribution, and a polynomial through the samples within three standard deviations of it.
  void flatten_base();
  void level();
  void level_by_polynomial(int degree);
  void filter(double cutoff_in_samples);
  struct Statistics {
    double Sa = 0.0, Sq = 0.0, Ssk = 0.0, Sku_excess = 0.0, Sz = 0.0, Sdq = 0.0, Sdr = 0.0;
  };
  [[nodiscard]] Statistics statistics() const;
  /// Not normalised; no lag in the middle.
  struct Lags {
    std::size_t columns = 0, rows = 0;
    std::vector<double> values;
  };
  [[nodiscard]] Lags autocorrelation() const;
  [[nodiscard]] double power_spectrum() const;  ///< only made; its sum
  [[nodiscard]] std::vector<double> bearing_curve(int points) const;
  void turn(double radians);
  void resample_by(double factor);
  void write(const std::filesystem::path& path) const;

private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace mezzotint::benchmark
