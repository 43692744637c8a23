#pragma once
#include <optional>
#include <vector>

#include "app/scenario/parts.h"

namespace faba {

/// The keys of an event that are no parts.
struct EventTime {
  std::uint64_t frame = 0;
  std::uint64_t swarm = 0;
  static Schema<EventTime> schema();
};

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
};

Json events_json(const std::vector<Event>& events);  ///< null when there are none
/// JSON Schema of [[event]].
Json events_json_schema(const Parts& parts);

}  // namespace faba
