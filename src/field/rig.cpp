#include <memory>

#include "core/schema.h"
#include "field/field.h"

namespace faba {
namespace {

/// One [[coil]] of a coil system: any kind of coil, described by the schema of its kind.
struct RigCoil {
  FieldRegistry::PartType part;

  struct Description {
    const FieldRegistry& coils;
    RigCoil parse(const Node& n) const { return {coils.resolve(n)}; }
    Json to_json(const RigCoil& c) const { return c.part.resolved; }
    Json json_schema() const { return coils.json_schema_of_any(); }
  };
  static Description schema(const void* coils) { return {*static_cast<const FieldRegistry*>(coils)}; }
};

struct Earth {
  Vec3 field;
  static Schema<Earth> schema() {
    return Schema<Earth>("earth", "Ambient field: the field without currents")
        .add("field", &Earth::field,
             {.unit = "T",
              .min = -1e-2,
              .max = 1e-2,
              .doc = "Field of the Earth and the surroundings, world frame",
              .role = Role::ambient});
  }
};

/// Any number of coils and the Earth's field (theory C4): B = B_earth + sum of I_k b_k. Mutual magnetisation
/// of cores and magnets keeps the field linear but changes every b_k; measured maps take it into account.
class Rig final : public Field {
 public:
  struct Params {
    std::vector<RigCoil> coil;
    Earth earth;
  };
  static constexpr std::array kTraits = {Trait::coil_system};
  static Schema<Params> schema(const std::shared_ptr<const FieldRegistry>& coils) {
    return Schema<Params>("rig", "A coil system: any number of coils and the Earth's field")
        .add("coil", &Params::coil,
             {.doc = "The coils, one [[coil]] each, in the order of the currents", .context = coils})
        .add("earth", &Params::earth, {.doc = "Ambient field: the field without currents"})
        .check([](const Params& p) -> std::string {
          return p.coil.empty() ? "has no coils; add at least one [[coil]], or name a file with coils: "
                                  "file = \"rig.toml\""
                                : "";
        })
        .validity(
            "Mutual magnetisation of ferrite cores is not modelled: use maps of each coil, measured with all "
            "cores in position.");
  }
  Rig(const Params& p, const FieldContext& c) : earth_(p.earth.field) {
    for (std::size_t i = 0; i < p.coil.size(); ++i) {
      parts_.push_back(p.coil[i].part.make(c));
      for (std::size_t k = 0; k < parts_.back()->coils(); ++k) index_.push_back({i, k});
    }
  }

  std::size_t coils() const override { return index_.size(); }
  void per_ampere(std::size_t coil, std::span<const Vec3> at, std::span<Vec3> b) const override {
    parts_[index_[coil].part]->per_ampere(index_[coil].coil, at, b);
  }
  Circuit circuit(std::size_t coil) const override {
    Circuit c = parts_[index_[coil].part]->circuit(index_[coil].coil);
    if (c.name.empty()) c.name = "coil " + std::to_string(coil);
    return c;
  }
  Vec3 ambient() const override { return earth_; }
  double clearance(Vec3 at) const override {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& p : parts_) least = std::min(least, p->clearance(at));
    return least;
  }
  bool encloses(std::size_t coil, Vec3 at) const override {
    return parts_[index_[coil].part]->encloses(index_[coil].coil, at);
  }
  std::vector<Stroke> outline() const override {
    std::vector<Stroke> all;
    for (const auto& p : parts_)
      for (auto& s : p->outline()) all.push_back(std::move(s));
    return all;
  }

 private:
  struct Index {
    std::size_t part, coil;
  };
  Vec3 earth_;
  std::vector<std::unique_ptr<Field>> parts_;
  std::vector<Index> index_;  ///< of every coil
};

}  // namespace

// The coils are the parts registered before it.
void add_rig(FieldRegistry& r) {
  const auto coils =
      std::make_shared<const FieldRegistry>(r.only(Trait::coil, "coil", "A coil of a coil system: [[coil]]"));
  r.add<Rig>(Rig::schema(coils));
}

}  // namespace faba
