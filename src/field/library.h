#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "field/kernels/field_table.h"

namespace faba {

/// One entry of a library: currents, the zero of the in-plane field that they make, and its gradient.
struct LibraryEntry {
  std::vector<double> current;  ///< A, one per coil
  Vec2 zero;                    ///< m, world, z = 0
  /// Eigenvalues of the in-plane gradient at the zero, T/m, in ascending order.
  std::array<double, 2> gradient{};
};

/// The library of the thesis (3.3.4.2): many sets of currents, each with the zero of its field and the field
/// at the nodes of a grid. A controller uses the currents whose zero is nearest to the desired position.
class FieldLibrary {
 public:
  struct Content {
    std::string source;  ///< file name, for messages
    std::string rig;     ///< hash of the coil system that it was made for
    TableGrid grid;
    std::vector<LibraryEntry> entries;
    /// The field of an entry at all nodes, T: x and y of every node, row by row from the lowest.
    std::function<std::vector<float>(std::size_t entry)> field;
  };
  explicit FieldLibrary(Content content);
  FieldLibrary(const FieldLibrary&) = delete;
  FieldLibrary& operator=(const FieldLibrary&) = delete;
  ~FieldLibrary();

  const TableGrid& grid() const { return content_.grid; }
  const std::vector<LibraryEntry>& entries() const { return content_.entries; }
  /// As Content::field.
  std::vector<float> field(std::size_t entry) const { return content_.field(entry); }
  /// The field of a coil system at the nodes of the library's grid. Throws Error(input) unless the library
  /// was made for this coil system: the hashes and the fields of some of the entries must be equal.
  FieldTable table(const Field& field, const std::string& coil_hash) const;

  /// The entry whose zero is nearest to `at` (m) among those that trap cells of `polarity` (+1 north-seeking,
  /// -1 south-seeking); among equally near ones that with the least power. When no entry traps along both
  /// axes, as with two coils, among those whose trapping gradient exceeds the repelling one.
  std::optional<std::size_t> nearest(Vec2 at, int polarity) const;

 private:
  struct Tree;
  Content content_;
  std::unique_ptr<Tree> north_, south_;
};

}  // namespace faba
