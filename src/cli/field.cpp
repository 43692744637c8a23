#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "cli/output_file.h"
#include "cli/progress.h"
#include "cli/quantity.h"
#include "cli/verbs.h"
#include "core/error.h"
#include "study/pages/field_report.h"

namespace faba::cli {
namespace {

double metres(const std::string& option, const std::string& words) {
  return quantity_of(words, "m", option, "1 mm, -0.5 mm");
}

std::vector<double> amperes(const std::string& words) {
  std::vector<double> out;
  std::istringstream in(words);
  for (std::string one; std::getline(in, one, ',');) {
    char* end = nullptr;
    out.push_back(std::strtod(one.c_str(), &end));
    if (end == one.c_str() || *end != '\0' || !std::isfinite(out.back()))
      throw Error(Errc::usage, "--current", fmt::format("\"{}\" is not a number of amperes", one));
  }
  return out;
}

// To four decimals, without a sign before zero.
double millimetres(const nlohmann::ordered_json& metres) {
  return std::round(metres.get<double>() * 1e7) / 1e4 + 0.0;
}

// "1 mm, 0 mm" as metres.
Vec2 place(const std::string& option, const std::string& words) {
  const auto comma = words.find(',');
  if (comma == std::string::npos)
    throw Error(Errc::usage, option,
                fmt::format("needs two lengths, such as \"1 mm, -0.5 mm\"; \"{}\" is one", words));
  return {metres(option, words.substr(0, comma)),
          metres(option, words.substr(std::min(comma + 1, words.size())))};
}

Vec2 rectangle(const std::string& words) {
  const Vec2 size = place("--size", words);
  if (!(size.x > 0 && size.y > 0 && size.x <= 1 && size.y <= 1))
    throw Error(Errc::usage, "--size", "must be two lengths of up to 1 m, such as \"6 mm, 4.5 mm\"");
  return size;
}

}  // namespace

int field_at(const FieldVerb& v, const Common& c) {
  const FieldAtPoints f = field_at_points(v.rig, v.points);
  const auto unknown =
      std::count_if(f.b.begin(), f.b.end(), [](const Vec3& b) { return !std::isfinite(b.x + b.y + b.z); });
  if (unknown > 0 && !c.quiet)
    tell(fmt::format(
        "faba: note: {} of {} points lie outside of what was measured, where the field is not a number",
        unknown, f.b.size()));
  if (c.json) {
    fmt::print("{}\n", field_json(f).dump());
    return 0;
  }
  std::string out = "x_m,y_m,z_m,bx_t,by_t,bz_t\n";
  for (std::size_t i = 0; i < f.at.size(); ++i)
    out += fmt::format("{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n", f.at[i].x, f.at[i].y, f.at[i].z,
                       f.b[i].x, f.b[i].y, f.b[i].z);
  fmt::print("{}", out);
  return 0;
}

int field_map(const FieldVerb& v, const Common& c) {
  FieldMapOptions o;
  const Vec2 size = rectangle(v.size);
  o.width = size.x, o.height = size.y;
  o.current = amperes(v.current);
  if (!v.view.empty()) o.view = place("--view", v.view);
  if (!v.drop.empty()) o.drop_radius = metres("--drop", v.drop);
  if (o.drop_radius < 0) throw Error(Errc::usage, "--drop", "must not be negative");
  if (!v.check) {
    o.picture = v.picture, o.hdf5 = v.out;
    check_output(o.picture, "", v.force, {v.rig});
    check_output(o.hdf5, "", v.force, {v.rig});
    if (!o.picture.empty() && o.picture.extension() != ".png")
      throw Error(Errc::usage, o.picture.string(), "must end in .png, which is what is written");
  }
  const auto j = field_json(faba::field_map(v.rig, o));
  if (c.json) {
    fmt::print("{}\n", j.dump());
    return 0;
  }
  if (c.quiet) return 0;
  for (const auto& z : j["zeros"])
    fmt::print("zero at ({:.4f}, {:.4f}) mm: {}, {:.3g} and {:.3g} T/m\n", millimetres(z["at_m"][0]),
               millimetres(z["at_m"][1]), z["kind"].get<std::string>(),
               z["eigenvalues_t_per_m"][0].get<double>(), z["eigenvalues_t_per_m"][1].get<double>());
  if (const auto note = j["note"].get<std::string>(); !note.empty() && !v.check) tell("faba: note: " + note);
  if (!v.check) fmt::print("strongest {:.4g} mT\n", j["strongest_t"].get<double>() * 1e3);
  if (const auto& t = j["table"]; !t.is_null())
    fmt::print("table {} x {} nodes, {:.3g} um apart; largest error {:.1e} of a coil's largest field\n",
               t["columns"].get<int>(), t["rows"].get<int>(), t["spacing_m"].get<double>() * 1e6,
               t["error"].get<double>());
  for (const auto& file : {o.picture, o.hdf5})
    if (!file.empty()) fmt::print("  {}\n", file.string());
  return 0;
}

int field_tolerance(const FieldVerb& v, const Common& c) {
  check_output(v.picture, ".svg", v.force, {v.rig, v.measured});
  const auto j = field_json(faba::field_tolerance(v.rig, place("--at", v.at), v.picture));
  if (c.json) {
    fmt::print("{}\n", j.dump());
    return 0;
  }
  if (c.quiet) return 0;
  std::string before;
  for (const auto& row : j["rows"]) {
    if (!before.empty() && before != row["cause"]) fmt::print("\n");
    before = row["cause"].get<std::string>();
    fmt::print("{:<42}{}\n", row["words"].get<std::string>(),
               row["lost"] == true ? "the zero is gone"
                                   : fmt::format("{:>8.4f} mm", row["shift_m"].get<double>() * 1e3));
  }
  if (!v.picture.empty()) fmt::print("  {}\n", v.picture.string());
  return 0;
}

int field_library(const LibraryVerb& v, const Common& c) {
  check_output(v.out, "", v.force, {v.rig});
  FieldLibraryOptions o;
  const Vec2 size = rectangle(v.size);
  o.width = size.x, o.height = size.y;
  if (!v.spacing.empty()) o.spacing = metres("--spacing", v.spacing);
  if (!(o.spacing >= 0)) throw Error(Errc::usage, "--spacing", "must not be negative");
  o.levels = v.levels, o.threads = v.threads, o.force = v.force;
  Progress bar("library", !c.json && !c.quiet);
  o.progress = [&](std::uint64_t done, std::uint64_t total) { bar.update(done, total); };
  o.stop = [&stop = stop_requested()] { return stop.load(); };
  const auto j = field_json(build_field_library(v.rig, v.out, o));
  bar.clear();
  if (c.json) {
    fmt::print("{}\n", j.dump());
    return 0;
  }
  if (c.quiet) return 0;
  fmt::print("{} entries of {} x {} nodes, from {} sets of currents\n", j["entries"].get<std::uint64_t>(),
             j["columns"].get<int>(), j["rows"].get<int>(), j["combinations"].get<std::uint64_t>());
  if (const auto& off = j["off_m"]; !off.is_null())
    fmt::print(
        "nearest zero {:.3g} um away in the median, {:.3g} um at most; the solver's is at the place itself\n",
        off["median"].get<double>() * 1e6, off["largest"].get<double>() * 1e6);
  if (const auto& s = j["strength"]; !s.is_null())
    fmt::print("trap {:.3g} times as strong as the solver's in the median\n", s.get<double>());
  if (j["entries"] == 0)
    tell(
        "faba: note: no set of currents makes a zero of the field in this rectangle; a library needs two "
        "coils at least");
  else if (j["traps"] == 0)
    tell("faba: note: all zeros are saddles, which drive cells away along one direction");
  fmt::print("  {}\n", v.out.string());
  return 0;
}

int field_fit(const FieldVerb& v, const Common& c) {
  check_output(v.out, "", v.force, {v.rig, v.measured});
  check_output(v.picture, ".svg", v.force, {v.rig, v.measured});
  const auto j = field_json(faba::field_fit(v.rig, v.measured, v.out, v.picture));
  if (c.json) {
    fmt::print("{}\n", j.dump());
    return 0;
  }
  if (c.quiet) return 0;
  fmt::print("{:<12}{:>9.4f} +- {:.4f}\n", "gain", j["gain"].get<double>(), j["gain_se"].get<double>());
  const auto vector = [&](const char* what, const char* key, const char* error, double per_unit,
                          const char* unit) {
    for (std::size_t k = 0; k < 3; ++k)
      if (!j[error][k].is_null())
        fmt::print("{:<12}{:>9.4g} +- {:.2g} {}\n", fmt::format("{} {}", what, "xyz"[k]),
                   j[key][k].get<double>() / per_unit, j[error][k].get<double>() / per_unit, unit);
  };
  vector("shift", "shift_m", "shift_se_m", 1e-3, "mm");
  vector("offset", "offset_t", "offset_se_t", 1e-6, "uT");
  fmt::print("left over   {:>9.3g} uT rms of {:.4g} uT, {} values\n", j["rms_t"].get<double>() * 1e6,
             j["rms_field_t"].get<double>() * 1e6, j["values"].get<int>());
  for (const auto& file : {v.out, v.picture})
    if (!file.empty()) fmt::print("  {}\n", file.string());
  if (const auto note = j["note"].get<std::string>(); !note.empty())
    tell(fmt::format("faba: note: {}: {}", v.measured.string(), note));
  return 0;
}

int field_null(const FieldVerb& v, const Common& c) {
  const auto j = field_json(null_of_rig(v.rig, place("--at", v.at), v.polarity == "south" ? -1 : 1));
  if (c.json) {
    fmt::print("{}\n", j.dump());
    return 0;
  }
  if (c.quiet) return 0;
  for (std::size_t k = 0; k < j["coils"].size(); ++k)
    fmt::print("{:<12}{:>12.6g} A\n", j["coils"][k].get<std::string>(), j["currents_a"][k].get<double>());
  fmt::print("gradient    {:.4g} and {:.4g} T/m in the plane, {:.4g} T/m along z\n",
             j["eigenvalues_t_per_m"][0].get<double>(), j["eigenvalues_t_per_m"][1].get<double>(),
             j["dbz_dz_t_per_m"].get<double>());
  if (const auto note = j["note"].get<std::string>(); !note.empty())
    tell(fmt::format("faba: note: {}: {}", v.rig.string(), note));
  return 0;
}

}  // namespace faba::cli
