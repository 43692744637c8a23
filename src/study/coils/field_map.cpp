#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/scenario/rig_file.h"
#include "core/counted.h"
#include "core/file.h"
#include "core/h5/h5.h"
#include "field/kernels/field_table.h"
#include "study/coils/field_map.h"
#include "vision/draw/field_picture.h"
#include "vision/files/picture.h"

namespace faba {
namespace {

constexpr int kWidth = 800;  // width of the picture in px, number of columns of the file

struct Map {
  int width = 0, height = 0;
  double m_per_px = 0;
  std::vector<Vec3> at, b;  ///< row by row from the top, m and T

  Vec2 px(Vec2 world) const {
    return {world.x / m_per_px + (width - 1) / 2.0, (height - 1) / 2.0 - world.y / m_per_px};
  }
};

Map computed(const Field& field, const std::vector<double>& current, const FieldMapOptions& o) {
  Map m;
  m.width = kWidth;
  m.height = std::clamp(int(std::lround(kWidth * o.height / o.width)), 60, 4000);
  m.m_per_px = o.width / kWidth;
  for (int row = 0; row < m.height; ++row)
    for (int column = 0; column < m.width; ++column)
      m.at.push_back(
          {(column - (m.width - 1) / 2.0) * m.m_per_px, ((m.height - 1) / 2.0 - row) * m.m_per_px, 0});
  m.b.resize(m.at.size());
  field.at(m.at, current, m.b);
  return m;
}

const char* kind_of(const NullGradient& g) {
  return g[1] < 0 ? "traps north-seekers" : g[0] > 0 ? "traps south-seekers" : "saddle";
}

/// Deletes a file that was not renamed to its final name.
struct PartialFile {
  std::filesystem::path file;
  explicit PartialFile(std::filesystem::path f) : file(std::move(f)) {}
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;
  ~PartialFile() {
    std::error_code ec;
    if (!file.empty()) std::filesystem::remove(file, ec);
  }
};

void write_hdf5(const std::filesystem::path& file, const Map& m, const std::vector<double>& current) {
  const std::filesystem::path part = file.string() + ".part";
  PartialFile partial{part};
  H5File h5 = H5File::create(part);
  const auto columns = std::uint64_t(m.width);
  H5Table b = h5.table<double>("b_t", {columns, 3}, 16, columns, true);
  H5Table x = h5.table<double>("x_m", {}, 1024, 1, false), y = h5.table<double>("y_m", {}, 1024, 1, false);
  h5.attribute("/", "format", std::string("faba field map 1"));
  h5.attribute("b_t", "axes",
               std::string("row from the top, column from the left, (x right, y up, z to the camera)"));
  for (std::size_t k = 0; k < current.size(); ++k)
    h5.attribute("/", fmt::format("current_{}_a", k), current[k]);
  h5.begin_writing();
  std::vector<double> row(3 * columns);
  for (int r = 0; r < m.height; ++r) {
    for (std::size_t c = 0; c < columns; ++c) {
      const Vec3 v = m.b[std::size_t(r) * columns + c];
      row[3 * c] = v.x;
      row[3 * c + 1] = v.y;
      row[3 * c + 2] = v.z;
    }
    b.append<double>(row);
    y.append<double>({&m.at[std::size_t(r) * columns].y, 1});
  }
  for (std::size_t c = 0; c < columns; ++c) x.append<double>({&m.at[c].x, 1});
  h5.close();
  rename_complete(part, file);
  partial.file.clear();
}

void draw(const FieldMapOptions& o, const Field& field, const Map& m,
          const std::vector<FieldMap::Zero>& zeros) {
  FieldScene s;
  s.width = m.width;
  s.height = m.height;
  s.um_per_px = m.m_per_px * 1e6;
  if (o.view) s.view_px = (1 / m.m_per_px) * *o.view;
  s.drop_radius_px = o.drop_radius / m.m_per_px;
  for (const Vec3& v : m.b) s.b.push_back({v.x, v.y});
  for (const auto& stroke : field.outline()) {
    s.coils.emplace_back();
    for (const Vec3& p : stroke) s.coils.back().push_back(m.px({p.x, p.y}));
  }
  for (const FieldMap::Zero& z : zeros) s.zeros.push_back({m.px(z.at), z.kind});
  write_png(o.picture, draw_field(s));
}

// A map may include the coils; a table may not.
std::optional<FieldMap::Table> table_of(const Field& field, const FieldMapOptions& o) {
  try {
    const FieldTable table(field, {-o.width / 2, -o.height / 2}, {o.width / 2, o.height / 2});
    const TableGrid& grid = table.grid();
    return FieldMap::Table{grid.spacing, grid.columns, grid.rows, table.error()};
  } catch (const Error&) {
    if (o.picture.empty() && o.hdf5.empty()) throw;
    return std::nullopt;
  }
}

}  // namespace

std::vector<FieldMap::Zero> field_zeros(const Field& field, const std::vector<double>& current, double width,
                                        double height, int starts) {
  std::vector<FieldMap::Zero> found;
  if (std::all_of(current.begin(), current.end(), [](double i) { return i == 0; })) return found;
  for (int i = 0; i < starts; ++i)
    for (int j = 0; j < starts; ++j) {
      const Vec2 from{width * ((i + 0.5) / starts - 0.5), height * ((j + 0.5) / starts - 0.5)};
      const Vec2 at = find_null(field, current, from);
      if (!(std::fabs(at.x) <= width / 2 && std::fabs(at.y) <= height / 2)) continue;
      if (std::any_of(found.begin(), found.end(),
                      [&](const FieldMap::Zero& f) { return norm(f.at - at) < 1e-3 * width; }))
        continue;
      const NullGradient g = null_gradient(field, current, at);
      found.push_back({at, g, kind_of(g)});
    }
  return found;
}

FieldMap field_map(const std::filesystem::path& rig, const FieldMapOptions& o) {
  const auto field = read_rig(rig, builtin_parts()).make({});
  const std::vector<double> current = o.current.empty() ? field->default_currents() : o.current;
  if (current.size() != field->coils())
    throw Error(Errc::usage, "--current",
                fmt::format("has {}; it must have {}, one per coil", counted(current.size(), "value"),
                            field->coils()));
  std::string note;
  for (std::size_t k = 0; k < current.size(); ++k) {
    if (!(std::fabs(current[k]) <= 1e4))
      throw Error(Errc::usage, "--current",
                  fmt::format("{:g} A is out of range; it must be between -10000 and 10000 A", current[k]));
    if (std::fabs(current[k]) > field->circuit(k).max_current)
      note = fmt::format(
          "{0:g} A exceeds max_current = {1:g} A of the coil \"{2}\"; the map is computed with {0:g} A",
          current[k], field->circuit(k).max_current, field->circuit(k).name);
  }
  if (std::all_of(current.begin(), current.end(), [](double i) { return i == 0; }))
    note = fmt::format("all currents are zero; specify currents, such as --current {}",
                       fmt::join(std::vector<double>(current.size(), 0.5), ","));
  const Map m = computed(*field, current, o);
  FieldMap map{current, note, {}, 0, {}};
  map.zeros = field_zeros(*field, current, o.width, o.height);
  std::size_t known = 0;
  for (const Vec3& v : m.b) {
    if (!std::isfinite(v.x + v.y)) continue;
    ++known;
    map.strongest = std::max(map.strongest, norm(Vec2{v.x, v.y}));
  }
  if (known == 0)
    throw Error(Errc::usage, rig.string(),
                "the field is unknown in this rectangle, which is in a winding or outside the measured maps; "
                "choose another --size");
  if (known < m.b.size()) {
    const double unknown = 100.0 * double(m.b.size() - known) / double(m.b.size());
    map.note += fmt::format(
        "{}the field is unknown in {:.2g} % of this rectangle, in a winding or outside a measured map",
        map.note.empty() ? "" : "; ", unknown);
  }
  map.table = table_of(*field, o);
  if (!o.picture.empty()) draw(o, *field, m, map.zeros);
  if (!o.hdf5.empty()) write_hdf5(o.hdf5, m, current);
  return map;
}

}  // namespace faba
