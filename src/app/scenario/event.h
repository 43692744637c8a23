#pragma once
#include <optional>
#include <vector>

#include "app/scenario/parts.h"

namespace faba {

/// The keys of an event that are not parts.
struct EventTime {
  std::uint64_t frame = 0;
  std::uint64_t swarm = 0;
  static Schema<EventTime> schema();
};

/// A change during a run, one [[event]]: before control cycle `frame` the parts named here replace the
/// current ones and start from their initial state. The live lab records user actions as events, so that the
/// scenario repeats them.
struct Event {
  std::uint64_t frame = 0;
  std::size_t swarm = 0;  ///< index of the swarm whose model is exchanged
  std::optional<ModelRegistry::PartType> model;
  std::optional<EstimatorRegistry::PartType> estimator;
  std::optional<ReferenceRegistry::PartType> reference;
  std::optional<ControllerRegistry::PartType> controller;

  /// JSON as in a scenario.
  Json resolved() const;
};

Json events_json(const std::vector<Event>& events);  ///< null if there are none
/// JSON Schema of [[event]].
Json events_json_schema(const Parts& parts);

}  // namespace faba
