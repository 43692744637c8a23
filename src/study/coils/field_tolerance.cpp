#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "app/scenario/rig_file.h"
#include "core/file.h"
#include "core/units.h"
#include "field/null.h"
#include "study/coils/field_report.h"
#include "study/plot/plot_svg.h"

namespace faba {
namespace {

/// One way in which a rig may differ from its file, and how much of it is tried.
struct Cause {
  const char *name, *words, *unit;
  double per_unit;  ///< of the table's unit in SI
  std::vector<double> amounts;
};
const std::vector<Cause>& causes() {
  static const std::vector<Cause> all{
      {"current", "a coil's current, by", "%", 0.01, {1, 2, 5, 10, 20}},
      {"along", "a coil moved along its axis, by", "mm", 1e-3, {0.1, 0.2, 0.5, 1, 2}},
      {"across", "a coil moved across its axis, by", "mm", 1e-3, {0.1, 0.2, 0.5, 1, 2}},
      {"tilt", "a coil tilted, by", "deg", kDegree, {0.5, 1, 2, 5, 10}},
      {"earth", "an unknown field of", "uT", 1e-6, {2, 5, 10, 18, 50}}};
  return all;
}

Vec3 vector(const Json& j) { return {in_si(j[0]), in_si(j[1]), in_si(j[2])}; }
Json json(Vec3 v) { return Json::array({v.x, v.y, v.z}); }

/// The rig as its file says, and changed copies of it.
class Rigs {
 public:
  explicit Rigs(const std::filesystem::path& file) : parts_(builtin_parts()), part_(read_rig(file, parts_)) {}

  std::unique_ptr<Field> as_it_is() const { return part_.make({}); }
  std::size_t coils() const { return part_.resolved["coil"].size(); }
  /// Calls visit(field, currents) for every way in which one coil, or the ambient field, is off by `amount`
  /// (SI).
  void each(const Cause& cause, double amount, const std::vector<double>& current,
            const std::function<void(const Field&, const std::vector<double>&)>& visit) const {
    const std::string name = cause.name;
    if (name == "earth") {
      for (int i = 0; i < 8; ++i) {
        Json j = part_.resolved;
        const Vec3 earth = vector(j["earth"]["field"]),
                   off{std::cos(i * 45 * kDegree), std::sin(i * 45 * kDegree), 0};
        j["earth"]["field"] = json(earth + amount * off);
        visit(*made(j), current);
      }
      return;
    }
    if (name == "current") {
      for (std::size_t k = 0; k < current.size(); ++k)
        for (const double side : {1.0, -1.0}) {
          std::vector<double> off = current;
          off[k] *= 1 + side * amount;
          visit(*as_it_is(), off);
        }
      return;
    }
    for (std::size_t k = 0; k < coils(); ++k)
      for (const double side : {1.0, -1.0}) {
        Json j = part_.resolved;
        Json& coil = j["coil"][k];
        const bool turns = coil.contains("turn");  // a map has no axis: its x stands for it
        const double turn = turns ? in_si(coil["turn"]) : 0;
        const Vec3 raw = turns ? Vec3{std::cos(turn), std::sin(turn), 0} : vector(coil["axis"]);
        const Vec3 axis = (1 / norm(raw)) * raw;
        // Across its axis in the plane of the sample, which is where a zero can move to.
        const Vec3 in_plane{-axis.y, axis.x, 0};
        const Vec3 across = norm(in_plane) > 1e-6 ? (1 / norm(in_plane)) * in_plane : Vec3{1, 0, 0};
        if (name == "tilt" && turns)
          coil["turn"] = turn + side * amount;
        else if (name == "tilt")
          coil["axis"] = json(std::cos(amount) * axis + (side * std::sin(amount)) * across);
        else
          coil["position"] =
              json(vector(coil["position"]) + (side * amount) * (name == "along" ? axis : across));
        visit(*made(j), current);
      }
  }

 private:
  std::unique_ptr<Field> made(const Json& j) const {
    Document d;
    d.root = j;
    return parts_.field.resolve(Node(d)).make({});
  }
  Parts parts_;
  FieldRegistry::PartType part_;
};

void draw(const std::filesystem::path& file, const nlohmann::ordered_json& report) {
  Plot p;
  p.title = "How far the zero of the field moves";
  p.x.label = "amount, as a share of the largest tried";
  p.y.label = "shift of the zero (mm)";
  p.y.lo = 0;
  p.width = 560, p.height = 340;
  for (const Cause& cause : causes()) {
    Line line;
    line.label = fmt::format("{}, up to {:g} {}", cause.name, cause.amounts.back(), cause.unit);
    line.x = {0}, line.y = {0};
    for (const auto& row : report["rows"]) {
      if (row["cause"] != cause.name || row["lost"] == true) continue;
      line.x.push_back(row["amount"].get<double>() / cause.amounts.back());
      line.y.push_back(row["shift_m"].get<double>() * 1e3);
    }
    line.dashed = std::string(cause.name) == "across" || std::string(cause.name) == "tilt";
    p.add(std::move(line));
  }
  write_file(file, svg(p));
}

}  // namespace

nlohmann::ordered_json field_tolerance(const std::filesystem::path& rig, Vec2 at,
                                       const std::filesystem::path& picture) {
  const Rigs rigs(rig);
  const auto field = rigs.as_it_is();
  const FieldNull n = null_at(*field, at, 1, current_limits(*field));
  if (!n.reachable)
    throw Error(Errc::usage, rig.string(), "these coils cannot put a zero of the field there");
  nlohmann::ordered_json out;
  out["at_m"] = {at.x, at.y};
  out["currents_a"] = n.current;
  out["saddle"] = n.saddle;
  out["rows"] = nlohmann::ordered_json::array();
  for (const Cause& cause : causes())
    for (const double amount : cause.amounts) {
      double worst = 0;
      rigs.each(cause, amount * cause.per_unit, n.current,
                [&](const Field& f, const std::vector<double>& current) {
                  const Vec2 now = find_null(f, current, at);
                  worst = std::max(
                      worst, std::isfinite(now.x) ? norm(now - at) : std::numeric_limits<double>::infinity());
                });
      nlohmann::ordered_json row;
      row["cause"] = cause.name;
      row["words"] = fmt::format("{} {:g} {}", cause.words, amount, cause.unit);
      row["amount"] = amount;
      row["unit"] = cause.unit;
      row["lost"] = !std::isfinite(worst);
      row["shift_m"] = std::isfinite(worst) ? nlohmann::ordered_json(worst) : nlohmann::ordered_json();
      out["rows"].push_back(row);
    }
  if (!picture.empty()) draw(picture, out);
  return out;
}

}  // namespace faba
