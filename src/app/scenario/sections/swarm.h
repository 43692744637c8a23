#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "app/scenario/parts.h"

namespace faba {

/// One [[swarm]].
struct Swarm {
  enum class Polarity { north, south };
  struct Params {
    std::uint64_t count = 500;
    Polarity polarity = Polarity::south;
    double responding = 1;
    std::optional<double> heading;
  };
  static Schema<Params> schema();
  Params params;
  ModelRegistry::PartType model;
  StartRegistry::PartType start;
};

/// Reads [[swarm]]. Throws Error(usage).
std::vector<Swarm> read_swarms(const Node& root, const Parts& parts);
Json swarms_json(const std::vector<Swarm>& swarms);
Json swarms_json_schema(const Parts& parts);

}  // namespace faba
