#include "sim/exclusion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "core/random/draw_blocks.h"

namespace faba {
namespace {

constexpr std::size_t kCopyBlock = 8192, kSitesAtOnce = 1024;

// One for all worlds that this thread steps: its bitmaps are empty between two calls, and those of many
// worlds would not fit into the caches together.
TwoPhase& two_phase(const Grid& grid) {
  thread_local TwoPhase shared{Grid{}};
  shared.use(grid);
  return shared;
}

}  // namespace

Schema<Exclusion::Params> Exclusion::schema() {
  return Schema<Params>("exclusion", "At most one cell per site of the occupancy grid (one pixel)")
      .add("order", &Params::order,
           {.doc = "two-phase: all cells move simultaneously; published: the sequential loop of the thesis; "
                   "none: no exclusion, cells overlap",
            .source = "published: A2; two-phase: D4(iii)",
            .choices = {"two-phase", "published", "none"}})
      .add("follow", &Params::follow,
           {.doc = "two-phase: a site that becomes free in this step may be entered"})
      .add("collision", &Params::collision,
           {.doc =
                "published: a blocked cell stays, moves as far as the path is free, or moves along one axis",
            .source = "assumed stay: not specified in the thesis (A2)",
            .choices = {"stay", "last-free", "axis-split"}})
      .add("integer_positions", &Params::integer_positions,
           {.doc = "Cells are at pixel centres only, as in the published simulator (A1)"});
}

Exclusion::Exclusion(const Params& p, const Arena& arena, std::uint64_t seed)
    : p_(p), grid_(arena.grid()), seed_(seed) {
  if (!active()) return;
  const std::int32_t sites = grid_.columns * grid_.rows;
  taken_ = Sites(std::size_t(sites));
  if (p_.integer_positions)  // a cell at a pixel centre must not be outside the edge
    for (std::int32_t i = 0; i < sites; ++i)
      if (arena.depth(grid_.centre(i)) < 0) taken_.take(i);
}

Vec2 Exclusion::snapped(Vec2 p) const {
  return p_.integer_positions ? grid_.centre(grid_.index(float(p.x), float(p.y))) : p;
}

bool Exclusion::place(Vec2 p) {
  const std::int32_t site = grid_.index(float(p.x), float(p.y));
  const bool free = !taken_.taken(site);
  taken_.take(site);
  return free;
}

void Exclusion::occupy(const State& s) {
  if (!active()) return;
  const auto x = s.agents["x"], y = s.agents["y"];
  for (std::size_t i = 0; i < x.size(); ++i) taken_.take(grid_.index(x[i], y[i]));
}

std::int32_t Exclusion::last_free(std::int32_t from, std::int32_t to) const {
  // Bresenham's line from `from` to `to`; returns the last site before the first occupied one.
  int cx = from % grid_.columns, cy = from / grid_.columns;
  const int tx = to % grid_.columns, ty = to / grid_.columns;
  const int dx = std::abs(tx - cx), dy = -std::abs(ty - cy), sx = cx < tx ? 1 : -1, sy = cy < ty ? 1 : -1;
  int error = dx + dy;
  std::int32_t best = from;
  while (cx != tx || cy != ty) {
    const int twice = 2 * error;
    if (twice >= dy) {
      error += dy;
      cx += sx;
    }
    if (twice <= dx) {
      error += dx;
      cy += sy;
    }
    const std::int32_t cell = cy * grid_.columns + cx;
    if (taken_.taken(cell)) break;
    best = cell;
  }
  return best;
}

void Exclusion::published(State& s, std::span<const float> to_x, std::span<const float> to_y) {
  const auto x = s.agents["x"], y = s.agents["y"];
  std::array<std::int32_t, kSitesAtOnce> home, site;
  for (std::size_t first = 0; first < x.size(); first += kSitesAtOnce) {
    // An agent is at its present position until its turn, so all sites of a block can be found before.
    const std::size_t n = std::min(kSitesAtOnce, x.size() - first);
    find_sites(grid_, x.subspan(first, n), y.subspan(first, n), home.data());
    find_sites(grid_, to_x.subspan(first, n), to_y.subspan(first, n), site.data());
    if (p_.collision == Collision::stay) {
      for (std::size_t k = 0; k < n; ++k) {
        const std::size_t i = first + k;
        const bool open = !(taken_.taken(site[k]) && home[k] != site[k]);
        taken_.move(home[k], site[k], open);
        x[i] = open ? to_x[i] : x[i];
        y[i] = open ? to_y[i] : y[i];
      }
    } else {
      for (std::size_t k = 0; k < n; ++k) {
        const std::size_t i = first + k;
        move_or_turn_aside(x[i], y[i], to_x[i], to_y[i], home[k], site[k]);
      }
    }
  }
}

// One agent of the published order with one of the assumed rules for collisions.
void Exclusion::move_or_turn_aside(float& x, float& y, float to_x, float to_y, std::int32_t home,
                                   std::int32_t site) {
  const auto open = [&](std::int32_t c) { return c == home || !taken_.taken(c); };
  const auto go = [&](std::int32_t c, float px, float py) {
    taken_.move(home, c, true);
    x = px;
    y = py;
  };
  if (open(site)) {
    go(site, to_x, to_y);
  } else if (p_.collision == Collision::last_free) {
    if (const std::int32_t free = last_free(home, site); free != home)
      go(free, float(grid_.centre(free).x), float(grid_.centre(free).y));
  } else {
    const std::int32_t along_x = grid_.index(to_x, y), along_y = grid_.index(x, to_y);
    if (open(along_x))
      go(along_x, to_x, y);
    else if (open(along_y))
      go(along_y, x, to_y);
  }
}

void Exclusion::resolve(State& s, std::span<float> to_x, std::span<float> to_y, Pool& pool) {
  if (p_.integer_positions)
    for (std::size_t i = 0; i < to_x.size(); ++i) {
      const Vec2 p = grid_.centre(grid_.index(to_x[i], to_y[i]));
      to_x[i] = float(p.x);
      to_y[i] = float(p.y);
    }
  if (p_.order == Order::published) return published(s, to_x, to_y);
  const auto key = draw(seed_, kContestDraws, 0, std::uint32_t(s.step));
  const auto x = s.agents["x"], y = s.agents["y"];
  two_phase(grid_).resolve(x, y, to_x, to_y, taken_, std::uint64_t{key[0]} << 32 | key[1], p_.follow, pool);
  pool.for_blocks(x.size(), kCopyBlock, [&](std::size_t begin, std::size_t end) {
    std::copy(&to_x[begin], &to_x[begin] + (end - begin), &x[begin]);
    std::copy(&to_y[begin], &to_y[begin] + (end - begin), &y[begin]);
  });
}

}  // namespace faba
