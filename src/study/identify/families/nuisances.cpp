#include "study/identify/families/nuisances.h"

#include <algorithm>

namespace faba {
namespace {

constexpr std::size_t kMostFree = 8;
// Limit of the spread of the speed over the largest mean speed: that of the default of dipole, 45 um/s at
// 186 um/s (assumed).
constexpr double kWidest = 0.25;
// Scale of the prior of a fraction (assumed): most cells of a healthy culture swim. The median is 0.88, and
// 5 % of the prior is below 0.18.
constexpr double kHealthy = -4;

const char* const kSpeed = "swarm[0].model.speed";

bool is_given(const std::vector<FreeParameter>& free, const Variant& model, const std::string& path) {
  const std::string key = path.substr(path.find_last_of('.') + 1);
  const bool of_model = path.find(".model.") != std::string::npos;
  return std::any_of(free.begin(), free.end(), [&](const auto& p) { return p.path == path; }) ||
         std::any_of(model.set.begin(), model.set.end(), [&](const auto& s) { return s.first == path; }) ||
         (of_model && model.part.is_object() && model.part.contains(key));
}

// Largest mean speed of a model, m/s; 0 for cells that do not swim and for models without a speed.
double largest_speed(const std::vector<FreeParameter>& free, const Json& scenario) {
  for (const FreeParameter& p : free)
    if (p.path == kSpeed) return p.high;
  return scenario_number(kSpeed, scenario).value_or(0);
}

}  // namespace

std::vector<FreeParameter> default_nuisances(const std::vector<FreeParameter>& free, const Variant& model,
                                             bool has_field, const Json& scenario) {
  const double fastest = largest_speed(free, scenario);
  struct Nuisance {
    const char* path;
    bool matters;
    double high, stretch;
    const char* source;
  };
  const Nuisance all[] = {
      {"swarm[0].model.motile", fastest > 0, 1, kHealthy,
       "assumed: median 0.88, 90 % between 0.18 and 0.996"},
      {"swarm[0].responding", has_field, 1, kHealthy, "assumed: median 0.88, 90 % between 0.18 and 0.996"},
      {"swarm[0].model.speed_sd", fastest > 0, kWidest * fastest, 0,
       "assumed: uniform, up to a quarter of the largest mean speed"}};
  std::vector<FreeParameter> found;
  for (const Nuisance& n : all) {
    if (!n.matters || is_given(free, model, n.path) || !scenario_number(n.path, scenario)) continue;
    if (free.size() + found.size() == kMostFree) break;
    const Json range{{n.path, {0.0, n.high}}};
    FreeParameter p = read_free_parameters({range, "nuisances", nullptr}, scenario).front();
    p.stretch = n.stretch;
    p.nuisance_source = n.source;
    found.push_back(std::move(p));
  }
  return found;
}

}  // namespace faba
