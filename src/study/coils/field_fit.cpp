#include "study/coils/field_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "app/files/field_points.h"
#include "app/scenario/rig_editor.h"
#include "app/scenario/rig_file.h"
#include "core/file.h"
#include "core/random/distributions.h"
#include "core/units.h"
#include "field/field_data.h"
#include "study/coils/field_checks.h"
#include "study/coils/field_units.h"
#include "study/plot/plot_svg.h"

namespace faba {
namespace {

// The coil system with the fitted gain and position of the coils, and the fitted offset added to the Earth's
// field.
void write_rig(const std::filesystem::path& file, RigEditor rig, const FieldFit::Values& m,
               const std::string& data) {
  for (std::size_t k = 0; k < rig.coils(); ++k) {
    rig.scale_strength(k, m.gain);
    rig.move(k, {m.shift[0], m.shift[1], m.shift[2]});
  }
  rig.add_ambient({m.offset[0], m.offset[1], m.offset[2]});
  Json table = rig.resolved().resolved;
  table.erase("type");
  write_file(file, "# Fitted to " + data + " with `faba field fit`.\n" + to_toml(table));
}

void draw(const std::filesystem::path& file, const FieldModel& model, const std::vector<double>& predicted) {
  Plot p;
  p.title = "Residuals of the fitted coil system";
  p.x.label = "measured field (mT)";
  p.y.label = "measured - fitted (mT)";
  Scatter dots;
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    dots.x.push_back(1e3 * model.values()[i]);
    dots.y.push_back(1e3 * (model.values()[i] - predicted[i]));
  }
  p.add(Rule{.at = 0, .of_x = false}).add(std::move(dots));
  write_file(file, svg(p));
}

void check_values(const FieldModel& model, const std::string& data) {
  const auto n = Eigen::Index(model.values().size());
  const Eigen::Index p = model.parameters();
  if (n <= p)
    throw Error(Errc::input, data,
                fmt::format("has {} values for {} parameters; at least {} are needed", n, p, p + 1));
  const auto [low, high] = std::minmax_element(model.values().begin(), model.values().end());
  const auto& at = model.data().at;
  const bool one_place = std::all_of(at.begin(), at.end(), [&](const Vec3& r) { return r == at[0]; });
  if (*low == *high && !one_place)
    throw Error(
        Errc::input, data,
        fmt::format("all values of the field are {:g} T; check the column and the range of the probe", *low));
}

// If the table determines nothing in its units, but fits in others, the error names these.
DeterminedFit fit_or_units(FieldModel& model, const Field& field, std::optional<Vec3> centre,
                           const std::string& file) {
  try {
    return determined_fit(model, file);
  } catch (const Error&) {
    const auto units = likely_units(field, model.data(), centre, std::numeric_limits<double>::infinity());
    if (!units) throw;
    throw Error(
        Errc::input, file,
        fmt::format("a unit of the table is probably wrong: the coil system does not describe the table "
                    "in its units, but {}; correct the header, or give the units with --units",
                    units->evidence));
  }
}

}  // namespace

FieldFit field_fit(const std::filesystem::path& rig, const std::filesystem::path& measured,
                   const FieldFitOptions& options) {
  const Parts& parts = builtin_parts();
  const auto part = read_rig(rig, parts);
  const auto field = part.make({});
  const std::vector<double> current = field->default_currents();
  if (std::all_of(current.begin(), current.end(), [](double i) { return i == 0; }))
    throw Error(Errc::usage, rig.string(),
                "all currents are zero; set the `current` of its coils to that of the measurement");
  const RigEditor editor(parts.field, part.resolved);
  const auto centre = editor.coils() == 1 ? editor.position(0) : std::nullopt;
  const FieldData data = field_data(read_field_points(measured, options.format));
  FieldModel model(*field, data, centre.value_or(Vec3{}), options.evaluated);
  check_values(model, measured.string());
  const DeterminedFit determined = fit_or_units(model, *field, centre, measured.string());

  FieldFit fit;
  fit.values = model.values().size();
  fit.best = model.meaning(determined.solution.x);
  fit.standard_error = model.errors(determined.solution.standard_error);
  fit.t95 = student_t_quantile(0.975, double(Eigen::Index(fit.values) - model.parameters()));
  fit.rms = model.strength() * determined.solution.rms;
  fit.rms_field = model.strength();
  fit.undetermined = determined.undetermined;
  fit.warnings = field_warnings({*field, data, centre, model, determined}, fit);
  if (!options.out.empty()) write_rig(options.out, editor, fit.best, measured.filename().string());
  if (!options.picture.empty()) draw(options.picture, model, model.predicted(determined.solution.x));
  return fit;
}

}  // namespace faba
