// SPDX-License-Identifier: Apache-2.0
// Damaged meshes of every format: each is read or refused, soon, and without harm.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <utility>

#include "saccade/io/clouds/any_mesh.hpp"
#include "saccade/io/clouds/internal/mesh_text.hpp"
#include "saccade/io/clouds/ply_io.hpp"
#include "saccade/io/files/file_io.hpp"
#include "support/effort.hpp"
#include "support/temp_folder.hpp"
#include "support/text_mutator.hpp"
#include "unit/io/clouds/mesh_files.hpp"

namespace saccade {
namespace {

using Read = std::function<Result<TriangleMesh>(const std::string&)>;

/// Reads mutants of a file; every mesh must be whole, and every error one line.
void read_mutants(const std::string& format, const std::string& file, int mutants, const Read& read) {
  constexpr std::uint64_t kSeed{31};
  test::TextMutator mutated{kSeed};
  int accepted{0};
  double slowest_s{0.0};
  for (int i = 0; i < mutants; ++i) {
    const std::string mutant = mutated(file);
    const auto begin = std::chrono::steady_clock::now();
    const auto mesh = read(mutant);
    slowest_s = std::max(slowest_s, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    if (!mesh) {
      ASSERT_FALSE(mesh.error().message.empty()) << format << ", mutant " << i;
      ASSERT_EQ(mesh.error().to_string().find('\n'), std::string::npos) << format << ", mutant " << i;
      continue;
    }
    ++accepted;
    for (const auto& triangle : mesh->triangles) {
      for (const std::uint32_t corner : triangle)
        ASSERT_LT(corner, mesh->vertices.size()) << format << ", mutant " << i;
    }
  }
  EXPECT_GT(accepted, 0) << format << ", seed " << kSeed;
  EXPECT_LT(accepted, mutants) << format << ", seed " << kSeed;
  EXPECT_LT(slowest_s, 10.0) << format << ", seed " << kSeed;
}

TEST(MeshMutation, OurReadersTakeTenThousandOfEachFormat) {
  const TriangleMesh ball = test::made_ball(6);
  const auto parsed = [](auto parse) { return [parse](const std::string& file) { return parse(file); }; };
  const int mutants = test::scaled_cases(10'000);
  read_mutants("STL", test::stl_text(ball), mutants, parsed(parse_stl));
  read_mutants("binary STL", test::stl_binary(ball, "made"), mutants, parsed(parse_stl));
  read_mutants("OBJ", test::obj_text(ball), mutants, parsed(parse_obj));
  read_mutants("OFF", test::off_text(ball), mutants, parsed(parse_off));
  read_mutants("PLY", test::ply_text(ball), mutants, [](const std::string& file) -> Result<TriangleMesh> {
    SACCADE_TRY(const PlyFile ply, parse_ply(as_byte_span(file)));
    return mesh_from_ply(ply);
  });
}

/// Reads mutants as files, as assimp needs them, each in a child process.
void read_mutated_files(int mutants) {
  const test::TempFolder folder;
  const TriangleMesh ball = test::made_ball(6);
  for (const auto& [name, file] :
       {std::pair<const char*, std::string>{"a.dae", test::collada_text(ball)}, {"a.glb", test::glb_binary(ball)}}) {
    const std::filesystem::path path = folder / name;
    read_mutants(name, file, mutants, [&](const std::string& mutant) {
      std::ofstream{path, std::ios::binary | std::ios::trunc} << mutant;
      return read_any_mesh(path);
    });
  }
}

TEST(MeshMutation, AssimpIsKeptFromHarm) {
  if (test::kSanitized) GTEST_SKIP() << "sanitizers end the child with their own reports, and need its memory";
  read_mutated_files(12);  // assimp takes all the memory it may have for a few of them
}

TEST(MeshMutationEvidence, AssimpIsKeptFromHarmTenThousandTimes) { read_mutated_files(10'000); }

}  // namespace
}  // namespace saccade
