#pragma once
#include <optional>

#include "app/parts.h"

namespace faba {

struct Scenario;

/// A change while a run goes on, one [[event]]: before turn `frame` of the loop the parts that are named here
/// take the place of those that were there, and begin anew. What somebody does in the live lab is kept as
/// events, so that the scenario alone repeats it.
struct Event {
  std::uint64_t frame = 0;
  std::size_t swarm = 0;  ///< whose model it is
  std::optional<ModelRegistry::PartType> model;
  std::optional<EstimatorRegistry::PartType> estimator;
  std::optional<ReferenceRegistry::PartType> reference;
  std::optional<ControllerRegistry::PartType> controller;

  /// As it stands in a scenario.
  Json resolved() const;
  /// Makes the change in a scenario.
  void change(Scenario& s) const;
};

/// Reads an event against the scenario as it stands then, and makes the change in it. An estimator and a
/// reference that the new controller cannot do without are added. Throws Error(usage), leaving `now` as it
/// was.
Event read_event(const Node& n, Scenario& now, const Parts& parts);

/// JSON Schema of one event.
Json event_json_schema();

}  // namespace faba
