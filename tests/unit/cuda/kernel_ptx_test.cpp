// SPDX-License-Identifier: Apache-2.0
// The text of the kernels that the driver will compile: its form, and what NVIDIA's assembler says where it is there.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <type_traits>

#include "saccade/cuda/internal/all_kernels.hpp"
#include "saccade/cuda/internal/cuda_compute.hpp"
#include "support/ptx_text.hpp"
#include "support/temp_folder.hpp"

namespace saccade::internal::cuda {
namespace {

constexpr std::size_t kMostLocalBytes{128};  // stack frame per thread; a spilled table takes more
constexpr const char* kNoKernels{"this build has no kernels, for lack of a clang++ that compiles CUDA"};

struct ExpectedEntry {
  std::string name;
  std::string struct_name;
  std::size_t argument_bytes;
  std::size_t shared_bytes;
  unsigned threads;
};

template <class Kernel>
ExpectedEntry expected_entry(const char* name) {
  const std::size_t shared = std::is_empty_v<typename Kernel::Shared> ? 0 : sizeof(typename Kernel::Shared);
  return {name, Kernel::kName, sizeof(typename Kernel::Arguments), shared, Kernel::kThreads};
}

std::vector<ExpectedEntry> expected_entries() {
#define SACCADE_EXPECTED(name, Kernel) expected_entry<Kernel>(#name),
  return {SACCADE_ALL_KERNELS(SACCADE_EXPECTED)};
#undef SACCADE_EXPECTED
}

/// Returns what is wrong with the kernels' text.
std::vector<std::string> problems_of(std::string_view text) {
  test::PtxModule module = test::read_ptx(text);
  std::vector<std::string> problems = std::move(module.problems);
  if (!module.version.starts_with("6."))
    problems.push_back("version " + module.version);  // newer ones need newer drivers
  if (module.target != ptx_target()) problems.push_back("target " + module.target);
  if (module.address_size != "64") problems.push_back("addresses of " + module.address_size + " bits");
  const std::vector<ExpectedEntry> expected = expected_entries();
  if (module.entries.size() != expected.size()) problems.push_back(std::to_string(module.entries.size()) + " kernels");
  for (const ExpectedEntry& wanted : expected) {
    const auto found = std::find_if(module.entries.begin(), module.entries.end(),
                                    [&](const test::PtxEntry& entry) { return entry.name == wanted.name; });
    if (found == module.entries.end()) {
      problems.push_back("no kernel " + wanted.name);
      continue;
    }
    const auto check = [&](bool good, const char* what) {
      if (!good) problems.push_back(wanted.name + ": " + what);
    };
    check(found->parameter_bytes == std::vector{wanted.argument_bytes}, "arguments of another size");
    check(found->threads == wanted.threads, "another number of threads");
    check(found->shared_bytes == wanted.shared_bytes, "shared memory of another size");
    check(found->local_bytes <= kMostLocalBytes, "a large stack frame");
  }
  return problems;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(lines.size(), 10); ++i) text += lines[i] + "\n";
  return text;
}

TEST(KernelPtx, HasTheFormThatTheDriverExpects) {
  if (kernel_ptx().empty()) GTEST_SKIP() << kNoKernels;
  const std::vector<std::string> problems = problems_of(kernel_ptx());
  EXPECT_TRUE(problems.empty()) << joined(problems);
  for (const ExpectedEntry& entry : expected_entries()) EXPECT_EQ(entry.name, entry.struct_name);
}

/// Replaces the first occurrence; the text must hold it.
std::string replaced(std::string_view text, const std::string& what, const std::string& by) {
  std::string result{text};
  const std::size_t at = result.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return at == std::string::npos ? result : result.replace(at, what.size(), by);
}

TEST(KernelPtx, BadTextIsFound) {
  if (kernel_ptx().empty()) GTEST_SKIP() << kNoKernels;
  const std::string_view text = kernel_ptx();
  const std::vector<std::pair<std::string, std::string>> changes{
      {".target sm_70", ".target sm_90"},
      {".address_size 64", ".address_size 32"},
      {".visible .entry saccade_mark_blocks(", ".visible .entry saccade_mark_block("},
      {"saccade_count_scoring_rays_param_0[2", "saccade_count_scoring_rays_param_0[12"},
      {".maxntid 128", ".maxntid 64"},
      {"mul.rn.f32", "mul.f32"},
      {"add.rn.f32", "fma.rn.f32"},
      {"div.rn.f32", "div.approx.f32"},
      {"sub.rn.f32", "sub.rn.ftz.f32"},
      {"bra \t", "bra \tx"},
      {".reg .f32 \t%f<", ".reg .f32 \t%g<"},
      {"\t.reg .pred", "\t.local .align 8 .b8 \tdepot[4096];\n\t.reg .pred"},
      {"ret;", "call.uni foo;"},
      {".visible .entry saccade_mark_blocks", ".extern .func foo\n.visible .entry saccade_mark_blocks"},
  };
  for (const auto& [what, by] : changes) {
    EXPECT_FALSE(problems_of(replaced(text, what, by)).empty()) << what << " -> " << by;
  }
  EXPECT_FALSE(problems_of(text.substr(0, text.size() / 2)).empty());
  EXPECT_FALSE(problems_of("").empty());
}

TEST(KernelPtx, LimitsOfRegistersAreChangedByName) {
  const std::string text =
      "x\n.visible .entry one(\n.minnctapersm 1\n{\n}\n.visible .entry other(\n.minnctapersm 1\n{\n}\n";
  const std::string other =
      "x\n.visible .entry one(\n.minnctapersm 1\n{\n}\n.visible .entry other(\n.minnctapersm 12\n{\n}\n";
  EXPECT_EQ(with_blocks_per_unit(text, "other", 12), other);
  EXPECT_EQ(with_blocks_per_unit(text, "oth", 12), text);
  if (kernel_ptx().empty()) GTEST_SKIP() << kNoKernels;
  const std::string changed = with_blocks_per_unit(kernel_ptx(), CountScoringRays::kName, 12);
  EXPECT_NE(changed, kernel_ptx());
  EXPECT_TRUE(problems_of(changed).empty());
}

/// Output of a command, and its exit status.
struct Ran {
  int status{-1};
  std::string output;
};
Ran run_command(const std::string& command) {
  Ran ran;
  FILE* const pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return ran;
  std::array<char, 4096> part{};
  while (std::fgets(part.data(), part.size(), pipe) != nullptr) ran.output += part.data();
  ran.status = pclose(pipe);
  return ran;
}

TEST(KernelPtx, TheAssemblerTakesItForEachGpuThatItKnows) {
  if (kernel_ptx().empty()) GTEST_SKIP() << kNoKernels;
  if (run_command("ptxas --version").status != 0) GTEST_SKIP() << "ptxas of the CUDA toolkit is not installed";
  const test::TempFolder folder;
  const std::string ptx = folder.write("kernels.ptx", kernel_ptx()).string();
  const auto assemble = [&](const std::string& gpu, const std::string& file) {
    return run_command("ptxas -v -arch=" + gpu + " -o " + (folder / "kernels.cubin").string() + " " + file);
  };
  int assembled{0};
  for (const char* gpu : {"sm_70", "sm_75", "sm_80", "sm_90", "sm_120"}) {
    const Ran ran = assemble(gpu, ptx);
    if (ran.output.find("is not defined for option 'gpu-name'") != std::string::npos) continue;  // too old, or too new
    ++assembled;
    EXPECT_EQ(ran.status, 0) << gpu << ": " << ran.output;
    for (const ExpectedEntry& entry : expected_entries()) {
      EXPECT_NE(ran.output.find("Compiling entry function '" + entry.name + "'"), std::string::npos) << entry.name;
    }
    EXPECT_EQ(ran.output.find("warning"), std::string::npos) << ran.output;
    for (std::size_t at = ran.output.find("bytes spill stores"); at != std::string::npos;
         at = ran.output.find("bytes spill stores", at + 1)) {
      EXPECT_EQ(ran.output.substr(at - 2, 2), "0 ") << gpu << ": a kernel spills registers";
    }
  }
  EXPECT_GT(assembled, 0);
  const std::string bad = folder.write("bad.ptx", replaced(kernel_ptx(), "mul.rn.f32", "mul.rn.f31")).string();
  EXPECT_NE(assemble("sm_80", bad).status, 0);
}

}  // namespace
}  // namespace saccade::internal::cuda
