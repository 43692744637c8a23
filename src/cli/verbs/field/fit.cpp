#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>

#include "cli/command_line.h"
#include "cli/options/field.h"
#include "cli/output_file.h"
#include "cli/progress.h"
#include "cli/quality_text.h"
#include "study/pages/field_report.h"

namespace faba::cli {
namespace {

struct FieldFitVerb {
  std::filesystem::path rig, measured, out, picture;
  bool force = false;
};

void print_fitted(const char* what, const std::array<double, 3>& value, const std::array<double, 3>& error,
                  double per_unit, const char* unit) {
  for (std::size_t k = 0; k < 3; ++k)
    if (!std::isnan(error[k]))
      fmt::print("{:<12}{:>9.4g} +- {:.2g} {}\n", fmt::format("{} {}", what, "xyz"[k]), value[k] / per_unit,
                 error[k] / per_unit, unit);
}

int field_fit(const FieldFitVerb& v, const Common& c) {
  check_output(v.out, {".toml"}, v.force, {v.rig, v.measured});
  check_output(v.picture, {".svg"}, v.force, {v.rig, v.measured});
  check_distinct({v.out, v.picture});
  // The number of evaluations until convergence is not known.
  Progress bar("fit, evaluations of the field", !c.quiet && !c.json);
  const FieldFit fit = faba::field_fit(v.rig, v.measured, v.out, v.picture,
                                       [&](std::uint64_t evaluations) { bar.update(evaluations, 0); });
  bar.clear();
  if (c.json) {
    fmt::print("{}\n", field_json(fit).dump());
    return 0;
  }
  if (c.quiet) return 0;
  if (!std::isnan(fit.standard_error.gain))
    fmt::print("{:<12}{:>9.4f} +- {:.4f} (standard error)\n", "gain", fit.best.gain, fit.standard_error.gain);
  print_fitted("shift", fit.best.shift, fit.standard_error.shift, 1e-3, "mm");
  print_fitted("offset", fit.best.offset, fit.standard_error.offset, 1e-6, "uT");
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
           "  faba field fit rig.toml --map measured.h5 --out fitted.toml --picture residual.svg");
  v->add_option("rig", o->rig, "Coil system file (TOML), with the currents of the measurement")->required();
  v->add_option("--map", o->measured, "Measured field, CSV or HDF5; see `faba parts field map`")
      ->required()
      ->type_name("FILE");
  v->add_option("-o,--out", o->out, "Write a coil system file (.toml) with the fitted values")
      ->check(not_empty);
  v->add_option("--picture", o->picture, "Write a plot of the residuals, as SVG")->check(not_empty);
  v->add_flag("--force", o->force, "Replace existing files");
  v->callback([o, &line] { line.code = field_fit(*o, line.common); });
}

}  // namespace faba::cli
