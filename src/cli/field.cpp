#include <fmt/format.h>

#include <cmath>

#include "cli/verbs.h"
#include "core/error.h"
#include "core/units.h"
#include "study/field_report.h"

namespace faba::cli {
namespace {

double metres(const std::string& words) {
  const auto bad = [](const std::string& why) {
    return Error(Errc::usage, "--at", fmt::format("{}; write x and y such as \"1 mm, -0.5 mm\"", why));
  };
  Quantity q;
  try {
    q = parse_quantity(words);
  } catch (const std::invalid_argument& e) {
    throw bad(e.what());
  }
  if (q.dimension != parse_unit("m").dimension || !std::isfinite(q.value))
    throw bad(fmt::format("\"{}\" is not a length", words));
  return q.value;
}

// "1 mm, 0 mm" as metres.
Vec2 place(const std::string& words) {
  const auto comma = std::min(words.find(','), words.size());
  return {metres(words.substr(0, comma)), metres(words.substr(std::min(comma + 1, words.size())))};
}

}  // namespace

int field_at(const FieldVerb& v, const Common& c) {
  const FieldAtPoints f = field_at_points(v.rig, v.points);
  if (c.json) {
    nlohmann::ordered_json j{{"currents_a", f.current}, {"b_t", nlohmann::ordered_json::array()}};
    for (const Vec3& b : f.b) j["b_t"].push_back({b.x, b.y, b.z});
    fmt::print("{}\n", j.dump());
    return 0;
  }
  std::string out = "x_m,y_m,z_m,bx_t,by_t,bz_t\n";
  for (std::size_t i = 0; i < f.at.size(); ++i)
    out += fmt::format("{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n", f.at[i].x, f.at[i].y, f.at[i].z,
                       f.b[i].x, f.b[i].y, f.b[i].z);
  fmt::print("{}", out);
  return 0;
}

int field_null(const FieldVerb& v, const Common& c) {
  const auto j = null_report(v.rig, place(v.at), v.polarity == "south" ? -1 : 1);
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
    fmt::print(stderr, "faba: note: {}: {}\n", v.rig.string(), note);
  return 0;
}

}  // namespace faba::cli
