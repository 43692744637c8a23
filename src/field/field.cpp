#include "field/field.h"

namespace faba {

Vec3 Field::at(Vec3 point, std::span<const double> current) const {
  std::vector<Vec3> b(coils());
  basis(point, b, {});
  Vec3 sum = ambient();
  for (std::size_t k = 0; k < b.size(); ++k) sum = sum + current[k] * b[k];
  return sum;
}

}  // namespace faba
