// Answers of Slurm 22.05, and what a user can do about them.
#include "study/engines/slurm_answers.h"

#include <doctest/doctest.h>

using namespace faba;

namespace {

// Output of squeue --noheader --array --states=all --Format=..., shortened.
const std::string kAnswer =
    "8                   N/A                 CANCELLED           0                   PartitionTimeLimit  \n"
    "12                  1                   FAILED              768                 (NonZeroExitCode)   \n"
    "12                  2                   FAILED              9                   (JobLaunchFailure)  \n"
    "12                  3                   RUNNING             0                   node1               \n"
    "12                  4                   PENDING             0                   (Nodes required for job "
    "are DOWN)\n"
    "12                  5                   TIMEOUT             0                   (TimeLimit)         \n";

SlurmJob pending(const std::string& reason) { return {"1_1", "PENDING", 0, reason}; }

}  // namespace

TEST_CASE("states, exit codes, signals and reasons are read from squeue") {
  const auto jobs = squeue_jobs(kAnswer);
  REQUIRE(jobs.size() == 6);
  CHECK(jobs[0].name == "8_N/A");
  CHECK(jobs[0].ended());
  CHECK(jobs[1].name == "12_1");
  CHECK(jobs[1].exit == 3);
  CHECK(jobs[2].exit == -9);
  CHECK_FALSE(jobs[3].ended());
  CHECK(jobs[4].reason == "Nodes required for job are DOWN");
  CHECK(squeue_jobs("12 1 FAILED 3:0 None\n12 2 FAILED 0:15 None\n")[0].exit == 3);
  CHECK(squeue_jobs("12 1 FAILED 3:0 None\n12 2 FAILED 0:15 None\n")[1].exit == -15);
  CHECK_FALSE(jobs[4].held());
  CHECK(squeue_jobs("12 6 PENDING 0 (launch failed requeued held)  \n")[0].held());
  CHECK(squeue_jobs("").empty());
}

TEST_CASE("the end of a job names its cause and the key to change") {
  const auto jobs = squeue_jobs(kAnswer);
  CHECK(end_of_job(jobs[1], 3600) == std::pair<std::string, int>{"exit code 3", 3});
  CHECK(end_of_job(jobs[2], 3600) == std::pair<std::string, int>{"signal 9", -1});
  CHECK(end_of_job(jobs[5], 7200).first.starts_with("reached its time limit"));
  CHECK(end_of_job(jobs[5], 7200).first.find("time of [engine] is 120 min") != std::string::npos);
  CHECK(end_of_job({"1_1", "OUT_OF_MEMORY", 0, ""}, 60).first.find("--mem") != std::string::npos);
  CHECK(end_of_job({"1_1", "NODE_FAIL", 0, ""}, 60).first == "ended as NODE_FAIL");
}

TEST_CASE("jobs wait only when none runs; reasons that time does not remove are trouble") {
  CHECK(reason_of_waiting({}).empty());
  CHECK(reason_of_waiting(squeue_jobs(kAnswer)).empty());
  CHECK(reason_of_waiting({pending("None"), pending("Priority")}) == "Priority");
  CHECK(reason_of_waiting({pending("Resources"), {"1_2", "RUNNING", 0, ""}}).empty());
  CHECK(reason_of_waiting({pending("Resources"), {"1_2", "FAILED", 0, ""}}) == "Resources");
  for (const char* harmless : {"", "None", "Resources", "Priority"})
    CHECK(trouble_of_waiting(harmless).empty());
  CHECK(trouble_of_waiting("PartitionTimeLimit").find("compare time, partition") != std::string::npos);
  CHECK(trouble_of_waiting("JobHeldAdmin") == "all jobs of Slurm wait: JobHeldAdmin");
}

TEST_CASE("errors of sbatch that time removes, and those that the user must correct") {
  for (const char* now :
       {"sbatch: error: Batch job submission failed: Unable to contact slurm controller (connect failure)",
        "sbatch: error: Batch job submission failed: Socket timed out on send/recv operation",
        "sbatch: error: Slurm temporarily unable to accept job, sleeping and retrying",
        "sbatch: error: AssocMaxSubmitJobLimit\nsbatch: error: Batch job submission failed: Job violates "
        "accounting/QOS policy (job submit limit, user's size and/or time limits)"})
    CHECK(refused_for_now(now));
  for (const auto& [answer, key] :
       {std::pair{
            "sbatch: error: invalid partition specified: x\nsbatch: error: Batch job submission failed: "
            "Invalid partition name specified\n",
            "partition"},
        {"sbatch: error: Batch job submission failed: Invalid account or account/partition combination "
         "specified",
         "account"},
        {"sbatch: error: Invalid --time specification", "time"},
        {"sbatch: unrecognized option '--nonsense'\nTry \"sbatch --help\" for more information",
         "options"}}) {
    CHECK_FALSE(refused_for_now(answer));
    CHECK_MESSAGE(refusal(answer).ends_with(std::string("correct ") + key + " in [engine]"), refusal(answer));
  }
  const char* elsewhere =
      "sbatch: error: fetch_config: DNS SRV lookup failed\nsbatch: fatal: Could not establish a "
      "configuration "
      "source";
  CHECK_FALSE(refused_for_now(elsewhere));
  CHECK_MESSAGE(refusal(elsewhere).ends_with("run the command on a login node of the cluster"),
                refusal(elsewhere));
  CHECK(
      refusal("sbatch: error: invalid partition specified: x\n").find(": invalid partition specified: x;") !=
      std::string::npos);
}
