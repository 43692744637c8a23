#pragma once
#include <optional>
#include <string>
#include <vector>

#include "app/scenario/parts.h"
#include "field/field_range.h"
#include "study/coils/field_map.h"

namespace faba {

/// What the editor of coil systems displays for a coil system with its default currents.
struct CoilDesignOptions {
  /// A plane through the centre: the sample (x, y), or seen from the side (x, z).
  enum class Plane { top, side };
  double width = 0.13, height = 0.13;  ///< of the rectangle about the centre, m
  int columns = 33, rows = 33;         ///< of the grid of the field
  std::vector<Plane> planes = {Plane::top};
  bool fast = false;      ///< search zeros from fewer points: some may be missing
  Vec3 probe = {};        ///< m
  Vec2 target = {};       ///< where the swarm is held, m
  int polarity = 1;       ///< of the cells: +1 north-seeking, -1 south-seeking
  double sample = 1e-3;   ///< radius of the sample, m
  SwarmMotion cell = {};  ///< of a typical cell
};

/// Whether a coil system can hold a swarm at a position, by a controller or by a zero of the field (theory
/// C8). `required` is infinite if no field does.
struct HoldStrength {
  struct Criterion {
    double available = 0, required = 0;
    bool met() const { return available >= required; }
  };
  /// Largest field in the weakest direction, T. Required: the swarm is aligned, turns within the sample, and
  /// is not tilted by more than 45 deg by the field along z without currents.
  Criterion steering;
  double for_alignment = 0, for_turning = 0;  ///< the two required fields, T
  FieldRange::Weakest weakest;                ///< direction, rad
  std::vector<double> around;                 ///< largest field in directions from 0 in equal steps, T
  double alignment = 0;                       ///< mean cosine in the field of the weakest direction
  double turning = 0;                         ///< rate of turning there, 1/s
  double u_turn = 0;                          ///< width of a U-turn there, m; infinite without a field
  /// Gradient of the strongest zero at the position along its weaker direction, T/m; negative if it repels.
  /// Required: two standard deviations of the swarm are within the sample.
  Criterion trap;
  double swarm_sd = 0;  ///< standard deviation of the swarm in this zero, m; infinite for a saddle
  /// Field along z at the position in the zero, T. The cells point along the total field: where it is
  /// stronger than the field in the plane, they swim out of it.
  double vertical = 0;
  bool tilted = false;   ///< the cells are tilted by more than 45 deg at half the radius of the sample
  bool crowded = false;  ///< the sample contains another zero of this field, so only a part of it is trapped
  bool trapped() const { return trap.met() && !tilted && !crowded; }
};

struct CoilDesign {
  std::vector<std::string> coils;  ///< their names
  std::vector<double> limit;       ///< of the currents, A, as used below; 1 A for a coil without a limit
  /// One grid for each plane, row by row from the top, T; NaN where the field is unknown.
  std::vector<std::vector<Vec3>> grids;
  Vec3 probe;                         ///< the field there, T
  std::vector<FieldMap::Zero> zeros;  ///< with the default currents, in the rectangle, z = 0
  FieldNull trap;                     ///< at the target; NaN where the field is unknown
  std::string inside;                 ///< name of the coil that has the target in it; empty if none has
  std::string reached;  ///< name of a coil that has a part of the sample in it; empty if none has
  HoldStrength hold;
};
CoilDesign coil_design(const Field& field, const CoilDesignOptions& options);

/// How a typical cell of a model turns and swims. Throws Error(usage) if the model has no such cell.
SwarmMotion turning_motion(const ModelRegistry::PartType& model);

}  // namespace faba
