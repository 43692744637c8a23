#include "server/scenarios/scenario_check.h"

#include "app/run/notes.h"
#include "app/scenario/read_scenario.h"
#include "app/scenario/scenario.h"

namespace faba {

Json scenario_check(const Document& d, const Parts& parts, const std::filesystem::path& root) {
  const Scenario s = read_scenario(d, parts);
  Pool pool(1);
  const Simulation simulation(s, s.params.seed.value_or(1), pool);
  return {{"ok", true},
          {"resolved", s.resolved()},
          {"toml", to_toml(s.resolved())},
          {"notes", scenario_notes(s, simulation, root)}};
}

}  // namespace faba
