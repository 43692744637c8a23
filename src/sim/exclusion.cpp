#include "sim/exclusion.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>

#include "core/philox.h"

namespace faba {
namespace {

constexpr std::uint32_t kFree = 0, kTaken = 0xFFFFFFFFu;
constexpr std::int32_t kNone = -1;     // nothing claimed: moved inside its own grid cell, or staying
constexpr std::int32_t kBlocked = -2;  // its wish was closed at the beginning of the step
constexpr std::size_t kBlock = 8192;
constexpr int kSweeps = 8;

}  // namespace

Schema<Exclusion::Params> Exclusion::schema() {
  return Schema<Params>("exclusion", "At most one cell per grid cell (one pixel)")
      .add("order", &Params::order,
           {.doc = "Who moves first: all at once, the thesis's sequential loop, or cells may overlap",
            .source = "published: A2; two-phase: D4(iii)",
            .choices = {"two-phase", "published", "none"}})
      .add("follow", &Params::follow,
           {.doc = "two-phase: a grid cell that its owner leaves in this step may be entered"})
      .add("collision", &Params::collision,
           {.doc = "published: a blocked cell stays, goes as far as the way is free, or tries one axis",
            .source = "assumed stay: the thesis does not say (A2)",
            .choices = {"stay", "last-free", "axis-split"}})
      .add("integer_positions", &Params::integer_positions,
           {.doc = "Cells stand on pixel centres only, as in the published simulator (A1)"});
}

Exclusion::Exclusion(const Params& p, const Arena& arena, std::uint64_t seed)
    : p_(p), grid_(arena.grid()), seed_(seed) {
  if (!active()) return;
  word_.assign(std::size_t(grid_.columns) * std::size_t(grid_.rows), kFree);
  if (p_.integer_positions)  // a cell snapped to a pixel centre must not stand outside the edge
    for (std::size_t i = 0; i < word_.size(); ++i)
      if (arena.depth(grid_.centre(std::int32_t(i))) < 0) word_[i] = kTaken;
}

Vec2 Exclusion::snapped(Vec2 p) const {
  return p_.integer_positions ? grid_.centre(grid_.index(float(p.x), float(p.y))) : p;
}

bool Exclusion::place(std::uint32_t agent, Vec2 p) {
  const std::int32_t cell = grid_.index(float(p.x), float(p.y));
  if (word_[std::size_t(cell)] != kFree) return false;
  word_[std::size_t(cell)] = kTaken;
  if (home_.size() <= agent) home_.resize(agent + 1);
  home_[agent] = cell;
  return true;
}

void Exclusion::occupy(const State& s) {
  if (!active()) return;
  const auto x = s.agents["x"], y = s.agents["y"];
  home_.resize(x.size());
  target_.assign(x.size(), kNone);
  for (std::size_t i = 0; i < x.size(); ++i) {
    home_[i] = grid_.index(x[i], y[i]);
    word_[std::size_t(home_[i])] = kTaken;
  }
}

// Compared only when two agents want one grid cell, so its cost does not matter.
std::uint64_t Exclusion::priority(std::uint64_t step, std::int32_t cell, std::uint32_t agent) const {
  const auto w = draw(seed_, Stream::exclusion, agent, std::uint32_t(step), std::uint32_t(cell));
  return std::uint64_t{w[0]} << 32 | w[1];
}

template <bool kShared>
void Exclusion::claim(State& s, const std::vector<float>& to_x, const std::vector<float>& to_y,
                      std::size_t begin, std::size_t end) {
  auto x = s.agents["x"], y = s.agents["y"];
  for (std::size_t i = begin; i < end; ++i) {
    const std::int32_t cell = grid_.index(to_x[i], to_y[i]);
    if (cell == home_[i]) {
      target_[i] = kNone;
      x[i] = to_x[i];
      y[i] = to_y[i];
      continue;
    }
    const std::uint32_t mine = std::uint32_t(i) + 1;
    const std::atomic_ref<std::uint32_t> word(word_[std::size_t(cell)]);
    std::uint32_t seen = word.load(std::memory_order_relaxed);
    bool won = false;
    while (seen != kTaken && !won) {
      if (seen != kFree && priority(s.step, cell, seen - 1) < priority(s.step, cell, mine - 1)) break;
      if constexpr (kShared) {
        won = word.compare_exchange_weak(seen, mine, std::memory_order_relaxed);
      } else {  // a locked instruction costs more than the rest of this loop
        word.store(mine, std::memory_order_relaxed);
        won = true;
      }
    }
    target_[i] = seen == kTaken ? kBlocked : cell;
  }
}

void Exclusion::settle(State& s, const std::vector<float>& to_x, const std::vector<float>& to_y,
                       std::size_t begin, std::size_t end) {
  auto x = s.agents["x"], y = s.agents["y"];
  for (std::size_t i = begin; i < end; ++i) {
    if (target_[i] < 0) continue;
    const std::atomic_ref<std::uint32_t> word(word_[std::size_t(target_[i])]);
    if (word.load(std::memory_order_relaxed) != std::uint32_t(i) + 1) continue;
    word.store(kTaken, std::memory_order_relaxed);
    std::atomic_ref<std::uint32_t>(word_[std::size_t(home_[i])]).store(kFree, std::memory_order_relaxed);
    home_[i] = target_[i];
    x[i] = to_x[i];
    y[i] = to_y[i];
  }
}

// Agents whose wish was closed try again after those before them have moved: sweep by sweep, each again all
// at once. Two that want to swap places block each other for good. One thread: the pile-ups where it matters
// are thin.
void Exclusion::follow(State& s, const std::vector<float>& to_x, const std::vector<float>& to_y) {
  std::vector<std::size_t> waiting;
  for (std::size_t i = 0; i < target_.size(); ++i)
    if (target_[i] == kBlocked) waiting.push_back(i);
  for (int sweep = 1; sweep < kSweeps && !waiting.empty(); ++sweep) {
    for (const std::size_t i : waiting) claim<false>(s, to_x, to_y, i, i + 1);
    for (const std::size_t i : waiting) settle(s, to_x, to_y, i, i + 1);
    const std::size_t before = waiting.size();
    std::erase_if(waiting, [&](std::size_t i) { return target_[i] != kBlocked; });
    if (waiting.size() == before) break;
  }
}

std::int32_t Exclusion::last_free(std::int32_t from, std::int32_t to) const {
  // Bresenham's line from `from` to `to`; the last grid cell before the first closed one.
  int cx = from % grid_.columns, cy = from / grid_.columns;
  const int tx = to % grid_.columns, ty = to / grid_.columns;
  const int dx = std::abs(tx - cx), dy = -std::abs(ty - cy), sx = cx < tx ? 1 : -1, sy = cy < ty ? 1 : -1;
  int error = dx + dy;
  std::int32_t best = from;
  while (cx != tx || cy != ty) {
    const int twice = 2 * error;
    if (twice >= dy) error += dy, cx += sx;
    if (twice <= dx) error += dx, cy += sy;
    const std::int32_t cell = cy * grid_.columns + cx;
    if (word_[std::size_t(cell)] != kFree) break;
    best = cell;
  }
  return best;
}

void Exclusion::published(State& s, const std::vector<float>& to_x, const std::vector<float>& to_y) {
  auto x = s.agents["x"], y = s.agents["y"];
  const auto go = [&](std::size_t i, std::int32_t cell, float px, float py) {
    word_[std::size_t(home_[i])] = kFree;
    word_[std::size_t(cell)] = kTaken;
    home_[i] = cell;
    x[i] = px;
    y[i] = py;
  };
  for (std::size_t i = 0; i < x.size(); ++i) {
    const std::int32_t cell = grid_.index(to_x[i], to_y[i]);
    if (cell == home_[i] || word_[std::size_t(cell)] == kFree) {
      go(i, cell, to_x[i], to_y[i]);
    } else if (p_.collision == Collision::last_free) {
      if (const std::int32_t free = last_free(home_[i], cell); free != home_[i])
        go(i, free, float(grid_.centre(free).x), float(grid_.centre(free).y));
    } else if (p_.collision == Collision::axis_split) {
      const std::int32_t along_x = grid_.index(to_x[i], y[i]), along_y = grid_.index(x[i], to_y[i]);
      if (along_x == home_[i] || word_[std::size_t(along_x)] == kFree)
        go(i, along_x, to_x[i], y[i]);
      else if (along_y == home_[i] || word_[std::size_t(along_y)] == kFree)
        go(i, along_y, x[i], to_y[i]);
    }
  }
}

void Exclusion::resolve(State& s, std::vector<float>& to_x, std::vector<float>& to_y, Pool& pool) {
  const std::size_t n = to_x.size();
  if (p_.integer_positions)
    pool.for_blocks(n, kBlock, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Vec2 p = grid_.centre(grid_.index(to_x[i], to_y[i]));
        to_x[i] = float(p.x);
        to_y[i] = float(p.y);
      }
    });
  if (p_.order == Order::published) return published(s, to_x, to_y);
  pool.for_blocks(n, kBlock, [&](std::size_t begin, std::size_t end) {
    pool.threads() > 1 ? claim<true>(s, to_x, to_y, begin, end) : claim<false>(s, to_x, to_y, begin, end);
  });
  pool.for_blocks(n, kBlock, [&](std::size_t begin, std::size_t end) { settle(s, to_x, to_y, begin, end); });
  if (p_.follow) follow(s, to_x, to_y);
}

}  // namespace faba
