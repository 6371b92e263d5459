#include "tests/benchmark/gwyddion_peer.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <libgwyddion/gwyddion.h>
#include <libgwyddion/gwythreads.h>
#include <libprocess/gwyprocess.h>

#include "forward/base/error.h"

namespace mezzotint::benchmark {

namespace {

struct Unref {
  void operator()(gpointer object) const {
    if (object != nullptr) g_object_unref(object);
  }
};
using Field = std::unique_ptr<GwyDataField, Unref>;
using Line = std::unique_ptr<GwyDataLine, Unref>;

void start_once() {
  static const bool started = [] {
    gwy_process_type_init();
    gwy_threads_set_enabled(FALSE);
    return true;
  }();
  static_cast<void>(started);
}

// All powers of x and y up to a total degree.
std::vector<gint> powers_up_to(int degree) {
  std::vector<gint> powers;
  for (int j = 0; j <= degree; ++j)
    for (int i = 0; i + j <= degree; ++i) powers.insert(powers.end(), {i, j});
  return powers;
}

struct Peak {
  double middle = 0.0, deviation = 0.0;
};

// A Gaussian through the peak of the height distribution.
Peak peak_of(GwyDataField* field) {
  const Line distribution(gwy_data_line_new(1, 1.0, FALSE));
  gwy_data_field_dh(field, distribution.get(), 0);
  const int count = gwy_data_line_get_res(distribution.get());
  const double step = gwy_data_line_get_real(distribution.get()) / count;
  const double offset = gwy_data_line_get_offset(distribution.get());
  const gdouble* density = gwy_data_line_get_data_const(distribution.get());
  const auto top = std::max_element(density, density + count) - density;
  auto left = top, right = top;
  while (left > 0 && density[left - 1] > 0.3 * density[top]) --left;
  while (right + 1 < count && density[right + 1] > 0.3 * density[top]) ++right;
  std::vector<double> x, y;
  for (auto k = left; k <= right; ++k) {
    x.push_back(offset + (static_cast<double>(k) + 0.5) * step);
    y.push_back(density[k]);
  }
  // x0, y0, height, width · √2
  std::vector<double> p = {offset + (static_cast<double>(top) + 0.5) * step, 0.0, density[top],
                           std::max(step, 0.5 * (x.back() - x.front()))};
  if (x.size() >= 6) {
    auto* preset = static_cast<GwyNLFitPreset*>(gwy_inventory_get_item(gwy_nlfit_presets(), "Gaussian"));
    std::vector<gboolean> fixed = {FALSE, TRUE, FALSE, FALSE};
    GwyNLFitter* fitter = gwy_nlfit_preset_fit(preset, nullptr, static_cast<gint>(x.size()), x.data(), y.data(),
                                               p.data(), nullptr, fixed.data());
    gwy_math_nlfit_free(fitter);
  }
  return {p[0], std::abs(p[3]) / std::sqrt(2.0)};
}

}  // namespace

struct GwyddionField::Data {
  Field field, mask;
};

GwyddionField::GwyddionField(const HeightField& heights) : data_(std::make_unique<Data>()) {
  start_once();
  const auto columns = static_cast<gint>(heights.columns()), rows = static_cast<gint>(heights.rows());
  const double width = heights.grid().pitch_x.um() * columns, depth = heights.grid().pitch_y.um() * rows;
  data_->field.reset(gwy_data_field_new(columns, rows, width, depth, FALSE));
  data_->mask.reset(gwy_data_field_new(columns, rows, width, depth, TRUE));
  gdouble* values = gwy_data_field_get_data(data_->field.get());
  gdouble* mask = gwy_data_field_get_data(data_->mask.get());
  for (std::size_t i = 0; i < heights.grid().size(); ++i) {
    const float z = heights.heights_um()[i];
    values[i] = std::isnan(z) ? 0.0 : static_cast<double>(z);
    mask[i] = std::isnan(z) ? 1.0 : 0.0;
  }
  gwy_data_field_invalidate(data_->field.get());
}

GwyddionField::GwyddionField(const std::filesystem::path& path) : data_(std::make_unique<Data>()) {
  start_once();
  gchar* bytes = nullptr;
  gsize size = 0, position = 4;  // behind "GWYP"
  require(g_file_get_contents(path.c_str(), &bytes, &size, nullptr) != FALSE, "cannot read " + path.string());
  GObject* container = gwy_serializable_deserialize(reinterpret_cast<const guchar*>(bytes), size, &position);
  const auto take = [&](const char* name) {
    GObject* object = nullptr;
    gwy_container_gis_object(reinterpret_cast<GwyContainer*>(container), g_quark_from_string(name), &object);
    return reinterpret_cast<GwyDataField*>(object == nullptr ? nullptr : g_object_ref(object));
  };
  data_->field.reset(take("/0/data"));
  data_->mask.reset(take("/0/mask"));
  g_object_unref(container);
  g_free(bytes);
}

GwyddionField::GwyddionField(const GwyddionField& other) : data_(std::make_unique<Data>()) {
  data_->field.reset(gwy_data_field_duplicate(other.data_->field.get()));
  if (other.data_->mask) data_->mask.reset(gwy_data_field_duplicate(other.data_->mask.get()));
}

GwyddionField::~GwyddionField() = default;

double GwyddionField::value(std::size_t index) const {
  return gwy_data_field_get_data_const(data_->field.get())[index];
}

std::size_t GwyddionField::masked() const {
  return static_cast<std::size_t>(gwy_data_field_get_sum(data_->mask.get()) + 0.5);
}

void GwyddionField::mask_outliers(double k) { gwy_data_field_mask_outliers(data_->field.get(), data_->mask.get(), k); }

void GwyddionField::fill() {
  gwy_data_field_laplace_solve(data_->field.get(), data_->mask.get(), -1, 1.0);
  gwy_data_field_clear(data_->mask.get());
}

void GwyddionField::flatten_base() {
  GwyDataField* field = data_->field.get();
  level();
  for (int degree = 2; degree <= 5; ++degree) {
    const Peak peak = peak_of(field);
    const Field base(gwy_data_field_new_alike(field, FALSE));
    gdouble* inside = gwy_data_field_get_data(base.get());
    const gdouble* values = gwy_data_field_get_data_const(field);
    const auto count = static_cast<std::size_t>(gwy_data_field_get_xres(field) * gwy_data_field_get_yres(field));
    for (std::size_t i = 0; i < count; ++i)
      inside[i] = std::abs(values[i] - peak.middle) <= 3.0 * peak.deviation ? 1.0 : 0.0;
    const std::vector<gint> powers = powers_up_to(degree);
    const auto terms = static_cast<gint>(powers.size() / 2);
    gdouble* coefficients = gwy_data_field_fit_poly(field, base.get(), terms, powers.data(), FALSE, nullptr);
    gwy_data_field_subtract_poly(field, terms, powers.data(), coefficients);
    g_free(coefficients);
  }
}

void GwyddionField::level() {
  gdouble a = 0.0, bx = 0.0, by = 0.0;
  gwy_data_field_fit_plane(data_->field.get(), &a, &bx, &by);
  gwy_data_field_plane_level(data_->field.get(), a, bx, by);
}

void GwyddionField::level_by_polynomial(int degree) {
  const std::vector<gint> powers = powers_up_to(degree);
  const auto terms = static_cast<gint>(powers.size() / 2);
  gdouble* coefficients = gwy_data_field_fit_poly(data_->field.get(), nullptr, terms, powers.data(), FALSE, nullptr);
  gwy_data_field_subtract_poly(data_->field.get(), terms, powers.data(), coefficients);
  g_free(coefficients);
}

void GwyddionField::filter(double cutoff_in_samples) {
  // exp(−π r²/(α λ)²) has the standard deviation α λ/√(2π).
  const double alpha = std::sqrt(std::log(2.0) / G_PI);
  gwy_data_field_filter_gaussian(data_->field.get(), alpha * cutoff_in_samples / std::sqrt(2.0 * G_PI));
}

GwyddionField::Statistics GwyddionField::statistics() const {
  GwyDataField* field = data_->field.get();
  gwy_data_field_invalidate(field);  // it remembers what it has computed once
  Statistics s;
  gdouble mean = 0.0, low = 0.0, high = 0.0;
  gwy_data_field_get_stats(field, &mean, &s.Sa, &s.Sq, &s.Ssk, &s.Sku_excess);
  gwy_data_field_get_min_max(field, &low, &high);
  s.Sz = high - low;
  s.Sdq = gwy_data_field_get_surface_slope(field);
  s.Sdr = gwy_data_field_get_surface_area(field) / (gwy_data_field_get_xreal(field) * gwy_data_field_get_yreal(field)) -
          1.0;
  return s;
}

GwyddionField::Lags GwyddionField::autocorrelation() const {
  GwyDataField* field = data_->field.get();
  const Field target(gwy_data_field_new_alike(field, FALSE));
  gwy_data_field_2dacf(field, target.get());
  const auto columns = static_cast<std::size_t>(gwy_data_field_get_xres(target.get()));
  const auto rows = static_cast<std::size_t>(gwy_data_field_get_yres(target.get()));
  const gdouble* values = gwy_data_field_get_data_const(target.get());
  return {columns, rows, {values, values + columns * rows}};
}

double GwyddionField::power_spectrum() const {
  GwyDataField* field = data_->field.get();
  const Field target(gwy_data_field_new_alike(field, FALSE));
  gwy_data_field_2dpsdf(field, target.get(), GWY_WINDOWING_HANN, 0);
  return gwy_data_field_get_data_const(target.get())[0];
}

std::vector<double> GwyddionField::bearing_curve(int points) const {
  const Line line(gwy_data_line_new(points, 1.0, FALSE));
  gwy_data_field_cdh(data_->field.get(), line.get(), points);
  const gdouble* values = gwy_data_line_get_data_const(line.get());
  return {values, values + gwy_data_line_get_res(line.get())};
}

void GwyddionField::turn(double radians) {
  data_->field.reset(gwy_data_field_new_rotated(data_->field.get(), nullptr, radians, GWY_INTERPOLATION_KEY,
                                                GWY_ROTATE_RESIZE_SAME_SIZE));
}

void GwyddionField::resample_by(double factor) {
  const auto times = [factor](gint count) { return static_cast<gint>(std::lround(factor * count)); };
  GwyDataField* field = data_->field.get();
  data_->field.reset(gwy_data_field_new_resampled(field, times(gwy_data_field_get_xres(field)),
                                                  times(gwy_data_field_get_yres(field)), GWY_INTERPOLATION_KEY));
}

void GwyddionField::write(const std::filesystem::path& path) const {
  GwyContainer* container = gwy_container_new();
  gwy_container_set_object(container, g_quark_from_string("/0/data"), data_->field.get());
  GByteArray* bytes = g_byte_array_new();
  g_byte_array_append(bytes, reinterpret_cast<const guint8*>("GWYP"), 4);
  gwy_serializable_serialize(reinterpret_cast<GObject*>(container), bytes);
  const bool written = g_file_set_contents(path.c_str(), reinterpret_cast<const gchar*>(bytes->data),
                                           static_cast<gssize>(bytes->len), nullptr) != FALSE;
  g_byte_array_free(bytes, TRUE);
  g_object_unref(container);
  require(written, "cannot write " + path.string());
}

}  // namespace mezzotint::benchmark
