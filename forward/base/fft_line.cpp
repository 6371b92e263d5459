#include "forward/base/fft_line.h"

#include <string>

#include "forward/base/error.h"
#include "forward/base/fftw_support.h"

namespace mezzotint {

namespace {

void require_valid_length(std::size_t length) {
  require(length >= 1 && length <= longest_side,
          "a Fourier transform of a line of " + std::to_string(length) + " samples; it must have 1 to 65536");
}

// std::complex<double> and fftw_complex share their layout (FFTW manual, "Complex numbers").
fftw_complex* as_fftw(std::complex<double>* values) { return reinterpret_cast<fftw_complex*>(values); }

}  // namespace

struct RealFftLine::Workspace {
  explicit Workspace(std::size_t count)
      : length(count),
        real(allocate_aligned<double>(count)),
        spectrum(allocate_aligned<std::complex<double>>(count / 2 + 1)) {
    const int n = static_cast<int>(count);
    const std::lock_guard lock(fftw_planner_mutex());
    forward = fftw_plan_dft_r2c_1d(n, real.get(), as_fftw(spectrum.get()), FFTW_ESTIMATE | FFTW_PRESERVE_INPUT);
    inverse = fftw_plan_dft_c2r_1d(n, as_fftw(spectrum.get()), real.get(), FFTW_ESTIMATE | FFTW_DESTROY_INPUT);
  }
  ~Workspace() {
    const std::lock_guard lock(fftw_planner_mutex());
    fftw_destroy_plan(forward);
    fftw_destroy_plan(inverse);
  }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  std::size_t length;
  std::unique_ptr<double[], FreeFftw> real;
  std::unique_ptr<std::complex<double>[], FreeFftw> spectrum;
  fftw_plan forward = nullptr, inverse = nullptr;
};

RealFftLine::RealFftLine(std::size_t length) {
  require_valid_length(length);
  workspace_ = std::make_unique<Workspace>(length);
}
RealFftLine::~RealFftLine() = default;
RealFftLine::RealFftLine(RealFftLine&&) noexcept = default;

std::span<double> RealFftLine::real() { return {workspace_->real.get(), workspace_->length}; }
std::span<std::complex<double>> RealFftLine::spectrum() {
  return {workspace_->spectrum.get(), workspace_->length / 2 + 1};
}
void RealFftLine::forward() { fftw_execute(workspace_->forward); }
void RealFftLine::inverse() { fftw_execute(workspace_->inverse); }

struct ComplexFftLine::Workspace {
  explicit Workspace(std::size_t count) : length(count), values(allocate_aligned<std::complex<double>>(count)) {
    const std::lock_guard lock(fftw_planner_mutex());
    forward = fftw_plan_dft_1d(static_cast<int>(count), as_fftw(values.get()), as_fftw(values.get()), FFTW_FORWARD,
                               FFTW_ESTIMATE);
  }
  ~Workspace() {
    const std::lock_guard lock(fftw_planner_mutex());
    fftw_destroy_plan(forward);
  }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  std::size_t length;
  std::unique_ptr<std::complex<double>[], FreeFftw> values;
  fftw_plan forward = nullptr;
};

ComplexFftLine::ComplexFftLine(std::size_t length) {
  require_valid_length(length);
  workspace_ = std::make_unique<Workspace>(length);
}
ComplexFftLine::~ComplexFftLine() = default;
ComplexFftLine::ComplexFftLine(ComplexFftLine&&) noexcept = default;

std::span<std::complex<double>> ComplexFftLine::values() { return {workspace_->values.get(), workspace_->length}; }
void ComplexFftLine::forward() { fftw_execute(workspace_->forward); }

}  // namespace mezzotint
