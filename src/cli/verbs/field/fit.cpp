#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>

#include "cli/command_line.h"
#include "cli/options/field.h"
#include "cli/output_file.h"
#include "cli/progress.h"
#include "cli/provenance.h"
#include "cli/quality_text.h"
#include "study/pages/field_report.h"
#include "study/quality/rounded.h"

namespace faba::cli {
namespace {

struct FieldFitVerb {
  std::filesystem::path rig, measured, out, picture;
  std::vector<std::string> columns, units;
  bool force = false;
};

// +- is the standard error.
void print_fitted(const std::string& name, double value, double error, double t95, const char* unit) {
  if (std::isnan(error)) return;
  const Rounded text = rounded(value, error);
  const RoundedInterval interval = rounded_interval(value, {value - t95 * error, value + t95 * error});
  fmt::print("{:<12}{:>9} +- {} {}, 95 % interval {} to {}\n", name, text.value,
             text.uncertainty.empty() ? "0" : text.uncertainty, unit, interval.low, interval.high);
}

void print_fitted(const char* what, const std::array<double, 3>& value, const std::array<double, 3>& error,
                  double t95, double per_unit, const char* unit) {
  for (std::size_t k = 0; k < 3; ++k)
    print_fitted(fmt::format("{} {}", what, "xyz"[k]), value[k] / per_unit, error[k] / per_unit, t95, unit);
}

int field_fit(const FieldFitVerb& v, const Common& c) {
  check_output(v.out, {".toml"}, v.force, {v.rig, v.measured});
  check_output(v.picture, {".svg"}, v.force, {v.rig, v.measured});
  check_distinct({v.out, v.picture});
  // The number of evaluations until convergence is not known.
  Progress bar("fit, evaluations of the field", !c.quiet && !c.json);
  const FieldFit fit = faba::field_fit(
      v.rig, v.measured, {{v.columns, v.units}, v.out, v.picture, [&](std::uint64_t evaluations) {
                            bar.update(evaluations, 0);
                          }});
  bar.clear();
  if (c.json) {
    print_json(field_json(fit), provenance_of(c, {v.rig, v.measured}));
    return 0;
  }
  if (c.quiet) return 0;
  print_fitted("gain", fit.best.gain, fit.standard_error.gain, fit.t95, "(standard error)");
  print_fitted("shift", fit.best.shift, fit.standard_error.shift, fit.t95, 1e-3, "mm");
  print_fitted("offset", fit.best.offset, fit.standard_error.offset, fit.t95, 1e-6, "uT");
  fmt::print("residual    {:>9.3g} uT rms, field {:.4g} uT rms, {} values\n", fit.rms * 1e6,
             fit.rms_field * 1e6, fit.values);
  for (const auto& file : {v.out, v.picture})
    if (!file.empty()) fmt::print("  {}\n", file.string());
  if (!fit.undetermined.empty()) fmt::print("not determined: {}\n", fmt::join(fit.undetermined, ", "));
  print_quality(fit.warnings, 12);
  return 0;
}

}  // namespace

void add_field_fit(CLI::App& field, CommandLine& line) {
  const auto o = std::make_shared<FieldFitVerb>();
  CLI::App* v =
      verb(field, line, "fit", "Fit a coil system to a measured field: gain, shift and background field",
           "  faba field fit rigs/flat-coil.toml --map measured.csv\n"
           "  faba field fit rig.toml --map measured.h5 --out fitted.toml --picture residual.svg\n"
           "  faba field fit rig.toml --map scan.dat --columns z,b --units cm,G");
  v->add_option("rig", o->rig, "Coil system file (TOML), with the currents of the measurement")
      ->required()
      ->transform(or_example("rigs"));
  v->add_option("--map", o->measured,
                "Measured field, text or HDF5: positions and components, or a scan along an axis")
      ->required()
      ->type_name("FILE");
  v->add_option(
       "--columns", o->columns,
       "Names of the columns of a text file, in order: x, y, z, rho, bx, by, bz, brho, b (the component "
       "along the only coordinate), - (not used); default: those in its header")
      ->delimiter(',')
      ->allow_extra_args(false);
  v->add_option(
       "--units", o->units,
       "Units of the columns, or one of length and one of field, such as cm,G; default: those in the "
       "header")
      ->delimiter(',')
      ->allow_extra_args(false);
  v->add_option("-o,--out", o->out, "Write a coil system file (.toml) with the fitted values")
      ->check(not_empty);
  v->add_option("--picture", o->picture, "Write a plot of the residuals, as SVG")->check(not_empty);
  v->add_flag("--force", o->force, "Replace existing files");
  v->callback([o, &line] { line.code = field_fit(*o, line.common); });
}

}  // namespace faba::cli
