#include "study/identify/families/model_family.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace faba {
namespace {

// Amounts that are simulated (assumed): large enough to be seen among the noise of some hundred cells, small
// enough for a linear extrapolation.
constexpr double kTumbles = 1, kReversals = 0.5;         // per s and cell
constexpr double kLess = 0.3;                            // of the fraction
constexpr double kSlowFraction = 0.3, kSlowSpeed = 0.4;  // of the cells, of their speed
constexpr double kOppositeFraction = 0.2;                // of the cells
constexpr double kStronger = 1.5, kWiderSpeeds = 0.25;   // factor; sd over mean of the speed
constexpr double kDelayFrames = 2, kDrift = 5;           // frames, px/s

const std::string kModel = "swarm[0].model.";

bool is_free(const Candidate& c, const std::string& path) {
  return std::any_of(c.free.begin(), c.free.end(), [&](const auto& p) { return p.path == path; });
}

std::string free_line(const std::string& path, const std::string& range) {
  return fmt::format("add to free: \"{}\" = {}", path, range);
}

double number_at(const Document& d, const std::string& path) {
  return scenario_number(path, d.root).value_or(0);
}

void set_number(Document& d, const std::string& path, double value, const char* unit) {
  d.set(path, *unit ? Json(fmt::format("{} {}", value, unit)) : Json(value), "family");
}

/// A rate or a fraction of the model, if it has one that is neither free nor zero by definition.
void add_parameter(std::vector<ModelFamily>& all, const Candidate& c, const Json& scenario,
                   const std::string& path, double change, const char* unit, const char* range,
                   ModelFamily family) {
  if (is_free(c, path) || !scenario_number(path, scenario)) return;
  if (family.amount == 0) family.amount = std::fabs(change);
  family.advice = free_line(path, range);
  family.edit = [path, change, unit](Document& d) {
    set_number(d, path, std::max(0.0, number_at(d, path) + change), unit);
  };
  all.push_back(std::move(family));
}

void add_swimming(std::vector<ModelFamily>& all, const Candidate& c, const Json& scenario) {
  add_parameter(all, c, scenario, kModel + "tumble_rate", kTumbles, "1/s", "[\"0 1/s\", \"10 1/s\"]",
                {.aspect = "turning", .what = "the cells tumble", .unit = "per s"});
  add_parameter(all, c, scenario, kModel + "reversal_rate", kReversals, "1/s", "[\"0 1/s\", \"5 1/s\"]",
                {.aspect = "turning", .what = "the cells reverse their motors", .unit = "per s"});
  add_parameter(
      all, c, scenario, kModel + "motile", -kLess, "", "[0, 1]",
      {.aspect = "motile_fraction", .what = "a part of the cells is not motile", .unit = "of them"});
  const double speed = scenario_number(kModel + "speed", scenario).value_or(0);
  add_parameter(all, c, scenario, kModel + "speed_sd", kWiderSpeeds * speed, "m/s",
                "[\"0 um/s\", \"100 um/s\"]",
                {.aspect = "speed_spread",
                 .what = "the speeds of the cells differ more",
                 .unit = "of the mean speed",
                 .amount = kWiderSpeeds});
  if (!(speed > 0) || scenario["swarm"].size() > 1) return;
  all.push_back(
      {.aspect = "populations",
       .what = "a second, slower population",
       .unit = "of the cells",
       .amount = kSlowFraction,
       .advice = "add to the model: populations = 2, and to free: \"swarm[1].model.speed\" = [\"0 um/s\", "
                 "\"100 um/s\"], \"swarm[1].count\" = [1, 1000]",
       .edit = [](Document& d) {
         divide_swarm(d, kSlowFraction);
         for (const char* key : {"speed", "speed_sd"})
           set_number(d, fmt::format("swarm[1].model.{}", key), kSlowSpeed * number_at(d, kModel + key),
                      "m/s");
       }});
}

void add_steering(std::vector<ModelFamily>& all, const Candidate& c, const Json& scenario) {
  add_parameter(all, c, scenario, "swarm[0].responding", -kLess, "", "[0, 1]",
                {.aspect = "responsive_fraction",
                 .what = "a part of the cells does not respond to the field",
                 .unit = "of them"});
  if (scenario["swarm"].size() == 1)
    all.push_back(
        {.aspect = "polarity",
         .what = "a part of the cells swims in the opposite direction",
         .unit = "of them",
         .amount = kOppositeFraction,
         .advice = "add to the model: populations = 2, set = { \"swarm[1].polarity\" = \"north\" }, and to "
                   "free: \"swarm[1].count\" = [1, 1000]",
         .edit = [](Document& d) {
           divide_swarm(d, kOppositeFraction);
           Json& second = d.root["swarm"][1];
           const bool north = second.contains("polarity") && second["polarity"] == "north";
           second["polarity"] = north ? "south" : "north";
           second.erase("heading");
         }});
}

void add_recording(std::vector<ModelFamily>& all) {
  all.push_back({.aspect = "field_strength",
                 .what = "the field is weaker or stronger than stated",
                 .unit = "of its strength",
                 .amount = kStronger - 1,
                 .two_sided = true,
                 .of_cells = false,
                 .advice = "check field_strength",
                 .field_factor = kStronger});
  all.push_back({.aspect = "timing",
                 .what = "the field reversals are earlier or later than stated",
                 .unit = "frames",
                 .amount = kDelayFrames,
                 .two_sided = true,
                 .of_cells = false,
                 .advice = "check reversal or [[video.segment]], and the frame rate",
                 .delay_frames = kDelayFrames});
  all.push_back({.aspect = "drift",
                 .what = "all cells drift along the axis of the field",
                 .unit = "px/s",
                 .amount = kDrift,
                 .two_sided = true,
                 .of_cells = false,
                 .advice = "fix the stage, wait until the fluid does not flow, or correct the video",
                 .drift_px_s = kDrift});
}

}  // namespace

void divide_swarm(Document& d, double fraction) {
  Json& swarms = d.root["swarm"];
  const double count = swarms[0]["count"].get<double>();
  Json second = swarms[0];
  second["count"] = std::max<std::int64_t>(1, std::llround(fraction * count));
  swarms[0]["count"] = std::max<std::int64_t>(1, std::llround((1 - fraction) * count));
  swarms.push_back(std::move(second));
}

std::vector<ModelFamily> families_of(const Candidate& c, const Json& scenario) {
  std::vector<ModelFamily> all;
  add_swimming(all, c, scenario);
  if (c.field_strength_t.value_or(kDefaultFieldStrength) > 0) add_steering(all, c, scenario);
  add_recording(all);
  return all;
}

}  // namespace faba
