#include "sim/two_phase.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>

#include "core/random/splitmix64.h"

namespace faba {
namespace {

constexpr std::int32_t kGranted = -1;
constexpr std::size_t kAgentsAtOnce = 1024;  // their sites fit into the L1 cache
constexpr unsigned kRegionShift = 20;        // sites of a region: their bits take 0.4 MB in decide()
constexpr std::size_t kAhead = 24;           // wishes whose words are fetched into the L1 cache in advance
constexpr std::size_t kWords = 2;            // of a block of sites: 128 sites
constexpr unsigned kSiteShift = 7;
constexpr std::size_t kFlags = sizeof(std::uint64_t);  // blocks that are skipped at once
constexpr std::size_t kBlocksAtOnce = 256 * kFlags;
constexpr std::size_t kSmall = 4096;  // agents for which threads do not pay
constexpr unsigned kMostParts = 8;    // each has three bits per site
constexpr int kSweeps = 8;            // of follow()

std::size_t word_of(std::int32_t site) { return std::size_t(site) >> 6; }

/// Fetches a word that is written soon into the nearest cache.
void fetch(const void* word) { __builtin_prefetch(word, 1); }

}  // namespace

std::uint64_t TwoPhase::priority(std::uint64_t key, std::int32_t cell, std::uint32_t agent) {
  return splitmix64(key ^ (std::uint64_t(std::uint32_t(cell)) << 32 | agent));
}

void TwoPhase::resolve(std::span<const float> x, std::span<const float> y, std::span<float> to_x,
                       std::span<float> to_y, Sites& taken, std::uint64_t key, bool follows, Pool& pool) {
  prepare(x.size(), taken.words().size(), x.size() <= kSmall ? 1 : std::min(pool.threads(), kMostParts));
  const auto each_part = [&](auto&& job) {
    if (parts_used_ == 1) return job(parts_[0]);
    pool.run(parts_used_, [&](std::size_t k) { job(parts_[k]); });
  };
  const auto each_block = [&](auto&& job) {
    if (parts_used_ == 1) return job(std::size_t{0}, blocks_);
    pool.for_blocks(blocks_, kBlocksAtOnce, job);
  };
  each_part([&](Part& p) {
    sort(x, y, to_x, to_y, p);
    mark(p);
  });
  each_block([&](std::size_t first, std::size_t end) { grant(taken, first, end); });
  each_part([&](Part& p) { decide(p); });
  settle(key);
  each_block([&](std::size_t first, std::size_t end) { update(taken, first, end); });
  if (follows) follow(taken, key);
  each_part([&](Part& p) {
    for (const Wish& w : p.refused()) {
      if (w.to == kGranted) continue;
      to_x[w.agent] = x[w.agent];
      to_y[w.agent] = y[w.agent];
    }
  });
}

void TwoPhase::prepare(std::size_t agents, std::size_t words, unsigned parts) {
  words_ = words;
  blocks_ = (words / (kWords * kFlags) + 1) * kFlags;
  parts_.resize(std::max<std::size_t>(parts_.size(), parts));
  parts_used_ = parts;
  before_.resize(words);
  for (std::size_t k = 0; k < parts; ++k) {
    Part& p = parts_[k];
    p.begin = agents * k / parts;
    p.end = agents * (k + 1) / parts;
    p.buckets.resize((words * 64 >> kRegionShift) + 1);
    p.wishes.resize(p.end - p.begin + kAhead);     // the last ones are read, but not used
    p.contested.resize(p.end - p.begin + kAhead);  // settle() reads beyond the end
    p.requests.resize(words);
    p.left.resize_words(words);
    p.used.resize(blocks_);
  }
}

template <class Use>
void TwoPhase::each_used_word(std::size_t first_block, std::size_t end_block, Use&& use) const {
  for (std::size_t first = first_block; first < end_block; first += kFlags) {
    std::uint64_t used = 0;  // a byte per block
    for (std::size_t k = 0; k < parts_used_; ++k) {
      std::uint64_t of_part = 0;
      std::memcpy(&of_part, &parts_[k].used[first], kFlags);
      used |= of_part;
    }
    for (; used != 0; used &= used - 1) {
      const std::size_t block = first + std::size_t(std::countr_zero(used)) / 8;
      for (std::size_t w = block * kWords; w < std::min(words_, (block + 1) * kWords); ++w) use(w);
    }
  }
}

// Without branches, which would often be mispredicted: an agent that stays on its site is written as well,
// and overwritten by the next one of its bucket, which has an element for each agent.
void TwoPhase::sort(std::span<const float> x, std::span<const float> y, std::span<const float> to_x,
                    std::span<const float> to_y, Part& part) const {
  std::array<std::int32_t, kAgentsAtOnce> from, to;
  const auto each_block = [&](auto&& use) {
    for (std::size_t first = part.begin; first < part.end; first += kAgentsAtOnce)
      use(first, std::min(kAgentsAtOnce, part.end - first));
  };
  std::fill(part.buckets.begin(), part.buckets.end(), Bucket{});
  if (part.buckets.size() > 1)
    each_block([&](std::size_t first, std::size_t n) {
      find_sites(grid_, x.subspan(first, n), y.subspan(first, n), from.data());
      for (std::size_t k = 0; k < n; ++k) ++part.buckets[std::size_t(from[k]) >> kRegionShift].end;
    });
  std::size_t begin = 0;
  for (Bucket& b : part.buckets) {
    const std::size_t size = b.end;
    b = {begin, begin};
    begin += size;
  }
  Bucket* const buckets = part.buckets.data();
  Wish* const wishes = part.wishes.data();
  each_block([&](std::size_t first, std::size_t n) {
    find_sites(grid_, x.subspan(first, n), y.subspan(first, n), from.data());
    find_sites(grid_, to_x.subspan(first, n), to_y.subspan(first, n), to.data());
    for (std::size_t k = 0; k < n; ++k) {
      std::size_t& end = buckets[std::size_t(from[k]) >> kRegionShift].end;
      wishes[end] = {std::uint32_t(first + k), from[k], to[k]};
      end += std::size_t{from[k] != to[k]};
    }
  });
}

void TwoPhase::mark(Part& part) {
  std::uint8_t* const used = part.used.data();
  const Wish* const wishes = part.wishes.data();
  Requests* const requests = part.requests.data();
  for (const Bucket& b : part.buckets)
    for (std::size_t i = b.begin; i < b.end; ++i) {
      fetch(&requests[word_of(wishes[i + kAhead].to)]);
      const Wish w = wishes[i];
      Requests& r = requests[word_of(w.to)];
      r.more |= r.once & Sites::bit(w.to);
      r.once |= Sites::bit(w.to);
      used[w.from >> kSiteShift] = 1;
      used[w.to >> kSiteShift] = 1;
    }
}

void TwoPhase::grant(const Sites& taken, std::size_t first_block, std::size_t end_block) {
  each_used_word(first_block, end_block, [&](std::size_t w) {
    std::uint64_t once = 0, more = 0;
    for (std::size_t k = 0; k < parts_used_; ++k) {
      const Requests& r = parts_[k].requests[w];
      more |= r.more | (once & r.once);
      once |= r.once;
    }
    const std::uint64_t open = ~taken.words()[w];
    parts_[0].requests[w] = {once & ~more & open, more & open};
  });
}

// Without branches. The list of the wishes that are not granted is in the place of those that have been read;
// the sign of `from` distinguishes the contested ones until they are moved to their list.
void TwoPhase::decide(Part& part) const {
  constexpr std::int32_t kContested = std::numeric_limits<std::int32_t>::min();
  Wish* const wishes = part.wishes.data();
  const Requests* const free = parts_[0].requests.data();
  std::uint64_t* const left = part.left.words().data();
  std::size_t others = 0;
  for (const Bucket b : part.buckets)
    for (std::size_t i = b.begin; i < b.end; ++i) {
      fetch(&free[word_of(wishes[i + kAhead].to)]);
      fetch(&left[word_of(wishes[i + kAhead].from)]);
      const Wish w = wishes[i];
      const Requests& f = free[word_of(w.to)];
      const std::uint64_t granted = f.once >> (w.to & 63) & 1, wanted = f.more >> (w.to & 63) & 1;
      left[word_of(w.from)] |= granted << (w.from & 63);
      wishes[others] = {w.agent, w.from | (wanted != 0 ? kContested : 0), w.to};
      others += 1 - granted;
    }
  Wish* const contested = part.contested.data();
  std::size_t contests = 0, refusals = 0;
  for (std::size_t i = 0; i < others; ++i) {
    const Wish w = wishes[i];
    const std::size_t wanted = w.from < 0 ? 1 : 0;
    contested[contests] = wishes[refusals] = {w.agent, w.from & ~kContested, w.to};
    contests += wanted;
    refusals += 1 - wanted;
  }
  part.contests = contests;
  part.refusals = refusals;
}

// One thread: few wishes are contested.
void TwoPhase::settle(std::uint64_t key) {
  const auto contested = [](const Part& p) { return p.contests > 0; };
  if (std::none_of(parts_.begin(), parts_.begin() + std::ptrdiff_t(parts_used_), contested)) return;
  const Requests* const free = parts_[0].requests.data();
  std::uint32_t sites = 0;
  each_used_word(0, blocks_, [&](std::size_t w) {
    if (free[w].more == 0) return;  // popcount is a call
    before_[w] = sites;
    sites += std::uint32_t(std::popcount(free[w].more));
  });
  const auto rank = [&](std::int32_t site) {
    const std::uint64_t smaller = free[word_of(site)].more & (Sites::bit(site) - 1);
    return std::size_t(before_[word_of(site)]) + std::size_t(std::popcount(smaller));
  };
  best_.assign(sites, std::numeric_limits<std::uint64_t>::max());
  winner_.resize(sites);
  ranks_.clear();
  for (const Part& p : std::span(parts_).first(parts_used_))
    for (const Wish& w : std::span(p.contested).first(p.contests)) {
      const std::size_t r = rank(w.to);
      ranks_.push_back(std::uint32_t(r));
      const std::uint64_t mine = priority(key, w.to, w.agent);
      const bool better = mine <= best_[r];
      best_[r] = better ? mine : best_[r];
      winner_[r] = better ? w.agent : winner_[r];
    }
  const std::uint32_t* r = ranks_.data();
  for (Part& p : std::span(parts_).first(parts_used_)) {
    std::uint64_t* const left = p.left.words().data();
    Wish* const refused = p.wishes.data();
    std::size_t refusals = p.refusals;
    for (std::size_t i = 0; i < p.contests; ++i) {
      fetch(&left[word_of(p.contested[i + kAhead].from)]);
      const Wish w = p.contested[i];
      const std::uint64_t wins = winner_[*r++] == w.agent;
      left[word_of(w.from)] |= wins << (w.from & 63);
      refused[refusals] = w;
      refusals += 1 - wins;
    }
    p.refusals = refusals;
  }
}

// After all decisions: occupied sites are closed to all wishes.
void TwoPhase::update(Sites& taken, std::size_t first_block, std::size_t end_block) {
  each_used_word(first_block, end_block, [&](std::size_t w) {
    const Requests entered = parts_[0].requests[w];
    std::uint64_t left = 0;
    for (Part& p : std::span(parts_).first(parts_used_)) {
      left |= p.left.words()[w];
      p.requests[w] = {};
      p.left.words()[w] = 0;
    }
    taken.words()[w] = (taken.words()[w] & ~left) | entered.once | entered.more;
  });
  for (Part& p : std::span(parts_).first(parts_used_))
    std::fill(&p.used[first_block], &p.used[first_block] + (end_block - first_block), std::uint8_t{0});
}

// Repeated simultaneous sweeps. Two agents that would swap sites block each other. One thread: few agents are
// affected.
void TwoPhase::follow(Sites& taken, std::uint64_t key) {
  std::vector<Wish*> waiting, winners;
  for (Part& p : std::span(parts_).first(parts_used_))
    for (Wish& w : p.refused()) waiting.push_back(&w);
  std::sort(waiting.begin(), waiting.end(), [key](const Wish* a, const Wish* b) {
    return a->to != b->to ? a->to < b->to : priority(key, a->to, a->agent) < priority(key, b->to, b->agent);
  });
  for (int sweep = 1; sweep < kSweeps; ++sweep) {
    winners.clear();
    for (std::size_t i = 0; i < waiting.size(); ++i)
      if ((i == 0 || waiting[i - 1]->to != waiting[i]->to) && !taken.taken(waiting[i]->to))
        winners.push_back(waiting[i]);
    if (winners.empty()) break;
    for (const Wish* w : winners) taken.take(w->to);
    for (Wish* w : winners) {
      taken.leave(w->from);
      w->to = kGranted;
    }
    std::erase_if(waiting, [](const Wish* w) { return w->to == kGranted; });
  }
}

}  // namespace faba
