#include "forward/base/fft.h"

#include <mutex>
#include <string>

#include "forward/base/error.h"
#include "forward/base/fftw_support.h"

namespace mezzotint {

namespace {

void require_valid_sides(std::size_t columns, std::size_t rows) {
  require(columns >= 1 && rows >= 1 && columns <= longest_side && rows <= longest_side,
          "a Fourier transform of " + std::to_string(columns) + " × " + std::to_string(rows) +
              " samples; each side must have 1 to 65536");
}

bool has_only_small_factors(std::size_t length) {
  for (const std::size_t factor : {2, 3, 5}) {
    while (length % factor == 0) length /= factor;
  }
  return length == 1;
}

}  // namespace

struct RealFft2d::Workspace {
  Workspace(std::size_t column_count, std::size_t row_count)
      : columns(column_count),
        rows(row_count),
        real(allocate_aligned<double>(columns * rows)),
        spectrum(allocate_aligned<std::complex<double>>(rows * (columns / 2 + 1))) {
    // std::complex<double> and fftw_complex share their layout (FFTW manual, "Complex numbers").
    auto* complex = reinterpret_cast<fftw_complex*>(spectrum.get());
    const int n0 = static_cast<int>(rows);
    const int n1 = static_cast<int>(columns);
    const std::lock_guard lock(fftw_planner_mutex());
    // FFTW_MEASURE times algorithms and may pick another one, with other roundings, in every run;
    // FFTW_ESTIMATE decides by rule. Our own buffers are aligned, so the rule always sees the same case.
    // (What MEASURE learns would also steer later estimates: nobody in this program may plan with it.)
    forward = fftw_plan_dft_r2c_2d(n0, n1, real.get(), complex, FFTW_ESTIMATE);
    inverse = fftw_plan_dft_c2r_2d(n0, n1, complex, real.get(), FFTW_ESTIMATE);
  }

  ~Workspace() {
    const std::lock_guard lock(fftw_planner_mutex());
    fftw_destroy_plan(forward);
    fftw_destroy_plan(inverse);
  }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  std::size_t columns;
  std::size_t rows;
  std::unique_ptr<double[], FreeFftw> real;
  std::unique_ptr<std::complex<double>[], FreeFftw> spectrum;
  fftw_plan forward = nullptr;
  fftw_plan inverse = nullptr;
};

RealFft2d::RealFft2d(std::size_t columns, std::size_t rows) {
  require_valid_sides(columns, rows);
  workspace_ = std::make_unique<Workspace>(columns, rows);
}
RealFft2d::~RealFft2d() = default;
RealFft2d::RealFft2d(RealFft2d&&) noexcept = default;
RealFft2d& RealFft2d::operator=(RealFft2d&&) noexcept = default;

std::size_t RealFft2d::columns() const { return workspace_->columns; }
std::size_t RealFft2d::rows() const { return workspace_->rows; }

std::span<double> RealFft2d::real() { return {workspace_->real.get(), columns() * rows()}; }

std::span<std::complex<double>> RealFft2d::spectrum() {
  return {workspace_->spectrum.get(), spectrum_columns() * rows()};
}

void RealFft2d::forward() { fftw_execute(workspace_->forward); }

void RealFft2d::inverse() {
  fftw_execute(workspace_->inverse);
  const double scale = 1.0 / static_cast<double>(columns() * rows());
  for (double& value : real()) value *= scale;
}

std::size_t quick_fft_length(std::size_t length) {
  require(length <= longest_side, "a Fourier transform's side may have at most 65536 samples");
  std::size_t quick = std::max<std::size_t>(2, length + length % 2);
  while (!has_only_small_factors(quick)) quick += 2;
  return quick;
}

}  // namespace mezzotint
