#include "scene.h"

#include "app/scenario/read_scenario.h"

#include <fmt/format.h>
#include <malloc.h>

#include <cmath>

namespace faba::bench {
namespace {

std::string toml(const Scene& s) {
  const Size size = box(s.agents);
  return fmt::format(
      "duration = 1\nexclusion = {{ order = '{}' }}\n"
      "arena = {{ type = 'box', size_px = [{}, {}], limits = 'clamp' }}\n"
      "field = {{ type = 'uniform', gain = 1 }}\n"  // currents in A equal fields in T
      "scale = {{ um_per_px = {}, field_unit = {} }}\ncamera = {{ rate = {} }}\nsimulation = {{ step = {} "
      "}}\n"
      "[[swarm]]\ncount = {}\npolarity = 'north'\nstart = 'uniform'\nmodel = {{ {} }}\n",
      s.order, size.width, size.height, kMetresPerPixel * 1e6, kFieldUnit, 1 / kStep, kStep, s.agents,
      s.model == "basic" ? fmt::format("type = 'basic', max_speed = {}, hold = {}", kBasicNoise, kHold)
      : s.model == "adapted"
          ? fmt::format("type = 'adapted', max_speed = {}, hold = {}", kAdaptedNoise, kHold)
          : "type = 'dipole'");
}

double heap() {
  const auto m = mallinfo2();
  return double(m.uordblks) + double(m.hblkhd);
}

}  // namespace

Size box(std::size_t agents) {
  const int height = int(std::ceil(std::sqrt(double(agents) * 10 * 3 / 4)));
  return {int(std::ceil(double(agents) * 10 / height)), height};
}

Swarm::Swarm(const Scene& scene, Pool& pool) : scene_(scene) {
  const Scenario s = read_scenario(parse_toml(toml(scene), "bench"), builtin_parts());
  const double before = heap();
  simulation_ = std::make_unique<Simulation>(s, 1, pool);
  advance(kCycle);  // the first steps allocate memory
  bytes_ = heap() - before;
  const Grid g = world().parts().arena->grid();
  if (scene.exclusive()) bytes_ -= double(g.columns) * g.rows;  // a byte each
  bytes_ /= double(scene.agents);
  saved_ = world().state();
}

void Swarm::take_headings(const Swarm& other) {
  for (const char* name : {"ux", "uy"}) {
    const auto from = other.world().state().agents[name];
    std::copy(from.begin(), from.end(), saved_.agents[name].begin());
  }
  saved_.step = other.world().state().step;
  saved_.t = other.world().state().t;
}

void Swarm::advance(int steps) {
  World& w = world();
  for (int i = 0; i < steps; ++i) {
    if (scene_.model == "dipole") {
      w.command({kField, 0});
    } else {
      const double sign = w.state().step % kCycle < kHold ? 1 : -1, earth = scene_.model == "adapted" ? 1 : 0;
      w.command({sign * kDrift.x * kFieldUnit, (sign * kDrift.y - earth) * kFieldUnit});
    }
    w.step();
  }
}

}  // namespace faba::bench
