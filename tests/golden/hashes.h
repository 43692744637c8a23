#pragma once
#include <cstdint>
#include <string>

namespace faba {

/// State hash of a scene after a number of frames, with seed 1.
struct Golden {
  std::string scene;
  std::uint64_t frames;  // number of frames, below the length of the scene
  std::string hash;
};
inline const Golden kGolden[] = {
    {"thesis-basic", 400, "7d7790d8cf06d60a"},
    {"thesis-adapted", 400, "88327a75cd63b497"},
    {"thesis-published", 400, "c00b37dd13c7146b"},
    {"corner", 90, "4b5a0bbcb7afa31f"},
    {"steer", 300, "c669e1531c58b809"},
    {"drop", 120, "a7a7fc4d66fdd991"},
    {"step-response", 60, "d22d42993f989a9a"},
    {"aging", 60, "2460151d4914c719"},
    {"null-route", 60, "544a9a838c98defc"},
    {"thesis-coils-c", 60, "f8b33655fe22ac22"},
};

}  // namespace faba
