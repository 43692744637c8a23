#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "app/files/installed_parts.h"
#include "cli/command_line.h"
#include "core/toml.h"
#include "study/sweep/program_version.h"

namespace faba::cli {
namespace {

// Value of "key : value" in a file in /proc; empty if it does not exist.
std::string value_of(const char* file, const char* key) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with(key)) continue;
    const auto begin = line.find_first_not_of(" \t", line.find(':') + 1);
    return begin == std::string::npos ? std::string() : line.substr(begin);
  }
  return {};
}

Json free_memory_gb() {
  const std::string kib = value_of("/proc/meminfo", "MemAvailable");
  return kib.empty() ? Json() : Json(std::round(std::strtod(kib.c_str(), nullptr) * 1.024e-3) / 1e3);
}

const char* vector_unit() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl")) return "AVX-512";
  if (__builtin_cpu_supports("avx2")) return "AVX2";
  return "SSE2";
#elif defined(__aarch64__)
  return "NEON";
#else
  return "that of the compiler's default target";
#endif
}

Json machine() {
  std::error_code ec;
  const auto space = std::filesystem::space(".", ec);
  return {{"version", FABA_VERSION},
          {"build", program_version()},
          {"processor", value_of("/proc/cpuinfo", "model name")},
          {"threads", std::thread::hardware_concurrency()},
          {"vector_unit", vector_unit()},
          {"memory_free_gb", free_memory_gb()},
          {"disk_free_gb", ec ? Json() : Json(std::round(double(space.available) * 1e-6) / 1e3)}};
}

void print_machine(const Json& j) {
  for (const auto& [name, key] : {std::pair{"version", "version"},
                                  {"build", "build"},
                                  {"processor", "processor"},
                                  {"threads", "threads"},
                                  {"vector unit", "vector_unit"}})
    fmt::print("{:<16}{}\n", name, j[key].is_string() ? j[key].get<std::string>() : j[key].dump());
  for (const auto& [name, key] :
       {std::pair{"free memory", "memory_free_gb"}, {"free disk space", "disk_free_gb"}})
    fmt::print("{:<16}{}\n", name,
               j[key].is_null() ? "unknown" : fmt::format("{:.1f} GB", j[key].get<double>()));
}

int doctor(const Common& c) {
  Json j = machine();
  const std::vector<InstalledPart> parts = installed_parts();
  const bool complete =
      std::all_of(parts.begin(), parts.end(), [](const auto& p) { return p.present || !p.required; });
  if (c.json) {
    for (const InstalledPart& p : parts)
      j["parts"].push_back(
          {{"name", p.name}, {"present", p.present}, {"required", p.required}, {"note", p.note}});
    fmt::print("{}\n", j.dump());
    return complete ? 0 : 1;
  }
  print_machine(j);
  fmt::print("\n");
  for (const InstalledPart& p : parts)
    fmt::print("{:<16}{:<9}{}\n", p.name, p.present ? "yes" : p.required ? "MISSING" : "no", p.note);
  return complete ? 0 : 1;
}

}  // namespace

void add_doctor(CLI::App& app, CommandLine& line) {
  CLI::App* v =
      verb(app, line, "doctor", "Report the properties of this machine, and which parts of Faba are missing",
           "  faba doctor");
  v->callback([&line] { line.code = doctor(line.common); });
}

}  // namespace faba::cli
