#pragma once

#include <string>
#include <vector>

#include "fabrication/calibration/cure_point.h"
#include "forward/surface/height_field.h"

namespace mezzotint {

enum class WedgeAxis { Longer, X, Y };

struct WedgeScanOptions {
  std::vector<double> grays;                    ///< of the steps side by side, in [0, 1]; from either end
  WedgeAxis along = WedgeAxis::Longer;          ///< the axis from step to step
  Length least_border = Length::from_um(25.0);  ///< left out on every side of a step: what the light's spread rounds
  double border_share = 0.15;                   ///< of the step's width, where that is more
  /// Of the wedge: what lies deeper than 1.25 of it below the highest steps is no part of it (the platform beside it).
  Length layer = Length::from_um(18.0);
};

/// One step of a wedge as measured.
struct WedgeStep {
  double gray = 0.0;
  Length from, to;         ///< along the wedge, from the scan's first sample
  double height_um = 0.0;  ///< mean over the base
  double standard_error_um = 0.0;
  std::size_t samples = 0;   ///< that were averaged
  std::size_t outliers = 0;  ///< that were left out, more than 5 robust standard deviations off
};

struct WedgeScan {
  WedgeAxis along = WedgeAxis::X;
  bool reversed = false;  ///< the steps told first lie at the far end
  Length step_width;
  Length across_from, across_to;      ///< where the steps lie across the wedge
  double tilt_x = 0.0, tilt_y = 0.0;  ///< of the plate, taken out
  double roughness_um = 0.0;          ///< RMS height within steps and base, about the plane
  double base_error_um = 0.0;         ///< standard error of the base's height, that all steps share
  std::size_t standing_out = 0;       ///< borders between steps whose heights differ by more than 4 standard errors
  std::vector<WedgeStep> steps;       ///< in the order told
  std::vector<double> profile_um;  ///< median across the steps, levelled, over the base; NaN where nothing was measured
  Length profile_pitch, profile_start;
  std::vector<std::string> notes;
};

/// Finds the steps of a printed wedge in a scan and measures them.
///
/// Layout    steps of one width side by side, over the middle of the scan across them; what lies beside them is base
///           (a frame of gray 0), and what lies far below it is left out. Without a frame, steps of gray 0 are the
///           base.
/// Steps     the lattice of as many equal strips as there are gray values that leaves least variance within strips and
///           frame, with heights that do not fall as gray values rise; so steps that did not cure, and are level with
///           the base, are found by the others.
/// Plate     its tilt is fitted within plateaus (each with a height of its own, the base with one in all its parts).
/// Errors    standard errors come from means over blocks, of the size that gives the largest ones: blocks smaller than
///           the roughness is correlated over would promise too much. All steps together tell how far blocks scatter.
/// @throws InvalidInput where the scan has no lattice of so many steps, saying how many it has; where a step has no
///         measured samples inside of its borders; where no base is seen.
[[nodiscard]] WedgeScan measure_wedge(const HeightField& scan, const WedgeScanOptions& options);

/// What the fit takes: a point a step.
[[nodiscard]] std::vector<CurePoint> cure_points(const WedgeScan& wedge);

}  // namespace mezzotint
