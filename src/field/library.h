#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "field/kernels/field_table.h"

namespace faba {

/// One entry of a library: currents, the zero of the in-plane field that they make, and what it does to
/// cells.
struct LibraryEntry {
  std::vector<double> current;  ///< A, one per coil
  Vec2 zero;                    ///< m, world, z = 0
  std::array<double, 2>
      gradient{};  ///< eigenvalues of the in-plane gradient there, T/m, the smaller one first
};

/// The library of the thesis (3.3.4.2): many sets of currents, each with the zero of the field that it makes
/// and the field at the nodes of a grid. A controller takes the currents whose zero is nearest to where it
/// wants one.
class FieldLibrary {
 public:
  struct Content {
    std::string source;  ///< file name, for messages
    std::string rig;     ///< hash of the coils that it was made for
    TableGrid grid;
    std::vector<LibraryEntry> entries;
    /// The field of an entry at all nodes, T: x and y of every node, row by row from below.
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
  /// The field of a rig at the nodes of the library's grid. Throws Error(input) unless this is the rig that
  /// the library was made for: the hashes are equal, and so is the field of some of the entries.
  FieldTable table(const Field& field, const std::string& coil_hash) const;

  /// The entry whose zero is nearest to `at` (m) among those that trap cells of `polarity` (+1 north-seeking,
  /// -1 south-seeking); of equally near ones that with the least power. Where none traps along both axes, as
  /// with two coils, among those that trap more along one than they drive away along the other.
  std::optional<std::size_t> nearest(Vec2 at, int polarity) const;

 private:
  struct Tree;
  Content content_;
  std::unique_ptr<Tree> north_, south_;
};

}  // namespace faba
