// Evidence and warnings: clear only for a model that explains the videos when the others are extended.
#include "study/identify/evidence.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "study/identify/identify_warnings.h"

using namespace faba;

namespace {

FoundModel model(const char* name, double score) {
  FoundModel m;
  m.name = name;
  m.fit_p = 0.5;
  m.score = score;
  m.scores = {score - 0.02, score, score + 0.02, score + 0.01};
  return m;
}

/// "basic" is better than "dipole" by about 1.
Identification compared() {
  Identification r;
  r.models = {model("dipole", 2), model("basic", 1)};
  r.models[1].scores = {0.98, 1.01, 1, 1.03};
  r.study.candidates.resize(2);
  return r;
}

FamilyCheck tumbling() {
  return {.aspect = "turning",
          .what = "the cells tumble",
          .unit = "per s",
          .advice = "add to free: \"swarm[0].model.tumble_rate\" = [\"0 1/s\", \"10 1/s\"]",
          .amount = 2,
          .sd = 0.2,
          .t = 10,
          .p = 1e-9,
          .explained = 0.5,
          .significant = true,
          .named = true};
}

bool warns(const Identification& r, const char* aspect, const char* advice) {
  const auto all = identify_warnings(r);
  return std::any_of(all.begin(), all.end(), [&](const Warning& w) {
    return w.aspect == aspect && w.advice.find(advice) != std::string::npos;
  });
}

}  // namespace

TEST_CASE("evidence: clear for the better model, without warnings") {
  Identification r = compared();
  judge(r);
  CHECK(r.best == 1);
  CHECK(r.evidence == "clear");
  CHECK(identify_warnings(r).empty());
}

TEST_CASE("evidence: not clear for a model with a doubtful fit, or whose cells do something else") {
  Identification r = compared();
  r.models[1].fit_p = 0.04;
  judge(r);
  CHECK(r.evidence != "clear");
  r = compared();
  r.models[1].families = {tumbling()};
  judge(r);
  CHECK(r.evidence != "clear");
  CHECK(r.words.find("the cells tumble") != std::string::npos);
  CHECK(warns(r, "turning", "swarm[0].model.tumble_rate"));
}

TEST_CASE("evidence: not clear when another model explains the videos as well if its cells tumble") {
  Identification r = compared();
  r.models[0].families = {tumbling()};
  r.models[0].extension = 0;
  r.models[0].extended_scores = {0.97, 1.03, 1.01, 1.04};
  judge(r);
  CHECK(r.best == 1);
  CHECK(r.evidence != "clear");
  CHECK(r.words.find("dipole if the cells tumble") != std::string::npos);
  CHECK(warns(r, "turning", "swarm[0].model.tumble_rate"));
  // An extension that does not help leaves the evidence as it is.
  r = compared();
  r.models[0].families = {tumbling()};
  r.models[0].extension = 0;
  r.models[0].extended_scores = {1.9, 1.95, 1.9, 1.95};
  judge(r);
  CHECK(r.evidence == "clear");
  CHECK(identify_warnings(r).empty());
}

TEST_CASE(
    "evidence: an extended model that is better than the best one is named, also without clear evidence") {
  Identification r = compared();
  r.models[0].scores = {0.5, 1.6, 0.9, 1.4};  // not clearly worse than "basic"
  r.models[0].score = 1.1;
  r.models[0].families = {tumbling()};
  r.models[0].extension = 0;
  r.models[0].extended_scores = {0.8, 0.9, 0.8, 0.9};
  judge(r);
  CHECK(r.best == 1);
  CHECK(r.evidence == "none");
  CHECK(warns(r, "turning", "swarm[0].model.tumble_rate"));
  r.models[0].extended_scores = {0.5, 1.6, 0.9, 1.35};  // no better than "basic"
  r.rival = {};
  judge(r);
  CHECK(identify_warnings(r).empty());
}

TEST_CASE("warnings: doubts about nuisance parameters are not reported") {
  Identification r = compared();
  FoundParameter p;
  p.parameter.path = "swarm[0].responding";
  p.doubt = "not identifiable";
  r.models[1].parameters = {p};
  judge(r);
  CHECK(identify_warnings(r).size() == 1);
  r.models[1].parameters[0].parameter.nuisance_source = "assumed";
  CHECK(identify_warnings(r).empty());
}

TEST_CASE("evidence: not clear when the search of another model ended in a wrong region") {
  Identification r = compared();
  r.models[0].converged = false;
  judge(r);
  CHECK(r.evidence != "clear");
  CHECK(warns(r, "search", "increase simulations"));
}
