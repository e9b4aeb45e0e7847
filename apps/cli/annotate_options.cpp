// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>

#include "add_value.hpp"
#include "annotate.hpp"
#include "options.hpp"
#include "size_options.hpp"

namespace saccade::cli {
namespace {

namespace fs = std::filesystem;

template <class T>
std::string text_of(const T& value) {
  std::ostringstream text;
  text << std::boolalpha << value;
  return text.str();
}

template <class T>
GivenGraphOption given(const std::string& name, T NeighbourhoodConfig::*value, const AnnotateOptions& options) {
  return [name, value, &options](const NeighbourhoodConfig& saved) -> std::optional<std::string> {
    if (options.graph.*value == saved.*value) return std::nullopt;
    return name + " " + text_of(options.graph.*value) + " does not fit: this session was begun with " +
           text_of(saved.*value) + "; leave the option out, or begin another session";
  };
}

template <class T>
void add_graph_option(CLI::App& command, AnnotateOptions& options, const std::string& name,
                      T NeighbourhoodConfig::*value, const std::string& description, const std::string& type) {
  CLI::Option* option = nullptr;
  if constexpr (std::is_same_v<T, bool>) {
    option = command.add_flag(name, options.graph.*value, description);
  } else {
    option = add_value(command, name, options.graph.*value, type, description);
  }
  option->each(
      [&options, name, value](const std::string&) { options.given_graph.push_back(given(name, value, options)); });
}

void add_graph_options(CLI::App& command, AnnotateOptions& options) {
  add_graph_option(command, options, "--neighbours", &NeighbourhoodConfig::neighbours,
                   "nearest points that each point is joined to", "K");
  add_graph_option(command, options, "--position-weight", &NeighbourhoodConfig::position_weight_per_m,
                   "cost of a metre", "WEIGHT");
  add_graph_option(command, options, "--normal-weight", &NeighbourhoodConfig::normal_weight,
                   "cost of a difference of normals of 1 (a right angle)", "WEIGHT");
  add_graph_option(command, options, "--color-weight", &NeighbourhoodConfig::color_weight,
                   "cost of an edge of the colour cube", "WEIGHT");
  add_graph_option(command, options, "--max-path", &NeighbourhoodConfig::max_path,
                   "a control point reaches as far as paths cost less than this", "COST");
  add_graph_option(command, options, "--adapt-to-density", &NeighbourhoodConfig::adapt_to_density,
                   "distances count by the local spacing of points, for clouds that thin out (LiDAR)", "");
}

void add_as_printed(CLI::App& command, AnnotateOptions& options) {
  options.graph.strong_borders = true;
  command
      .add_flag_callback(
          "--as-printed", [&options] { options.graph.strong_borders = false; },
          "costs by eq. 4.17 and clicks by Algorithms 8 and 9, to the letter: without the stronger borders at which "
          "later clicks of a label stop")
      ->each([&options](const std::string&) {
        options.given_graph.emplace_back([](const NeighbourhoodConfig& saved) -> std::optional<std::string> {
          if (!saved.strong_borders) return std::nullopt;
          return "--as-printed does not fit: this session was begun without it; leave the option out, or begin another "
                 "session";
        });
      });
}

constexpr const char* kWithoutPage{"Without the page"};
constexpr const char* kGraph{"The graph (of a session that is begun)"};

/// Half of the machine's memory.
std::size_t half_of_memory() {
  const auto pages = static_cast<std::size_t>(std::max(0L, ::sysconf(_SC_PHYS_PAGES)));
  return pages / 2 * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

void add_room_options(CLI::App& command, GraphRoom& room) {
  room.memory_bytes = half_of_memory();
  add_size(command, "--graph-memory", room.memory_bytes,
           "the graph of a cloud that needs more lies on disk, such as 12GiB (default: half of the machine's)");
  add_value(command, "--graph-folder", room.folder, "FOLDER", "folder for graphs on disk")
      ->check(CLI::ExistingDirectory);
}

void add_action_options(CLI::App& command, AnnotateOptions& options, CLI::Option& simulate) {
  CLI::Option* script = add_value(command, "--script", options.script, "FILE",
                                  "actions to do, one JSON object per line (docs/guides/annotation.md)")
                            ->check(CLI::ExistingFile)
                            ->group(kWithoutPage)
                            ->excludes(&simulate);
  add_value(command, "--session", options.session, "FILE",
            "goes on with the annotation in this file, or begins it; every action is in it before it counts. Of a "
            "folder: a folder of them (.sacann). The page's is beside the cloud, unless it is named here")
      ->excludes(&simulate);
  add_value(command, "--presets", options.presets, "FILE",
            "labels that are known: YAML or JSON (docs/reference/formats.md)")
      ->check(CLI::ExistingFile)
      ->excludes(&simulate);
  add_value(command, "--margins", options.margins, "FILE",
            "the cloud with a field margin, 0 (as near to another label) to 1 (sure), .pcd or .ply; the result says "
            "where another control point helps most")
      ->group(kWithoutPage)
      ->excludes(&simulate);
  CLI::Option* seeds =
      add_value(command, "--seeds", options.seeds, "LABELS",
                "labels to begin with, as --simulate takes them: control points are placed that give them back")
          ->check(CLI::ExistingPath)
          ->excludes(&simulate);
  add_value(command, "--seed-share", options.seed_share, "SHARE",
            "how many of them, at least, unless that takes too many")
      ->check(CLI::Range(0.5, 1.0))
      ->needs(seeds);
  add_value(
      command, "--segments", options.segments, "LABELS",
      "segments of the points, as `segment` writes them, in any format of labels: the page shows them, and a click "
      "accepts one whole; a script paints them with \"segments\": true. Of a folder: a folder of them")
      ->check(CLI::ExistingPath);
  add_value(command, "--client", options.client, "N",
            "who does the actions that name no client; undo is everyone's own")
      ->check(check_whole_number)
      ->needs(script)
      ->group(kWithoutPage);
}

void add_simulation_options(CLI::App& command, AnnotateOptions& options, CLI::Option& simulate) {
  add_value(command, "--clicks", options.clicks, "N", "clicks per label")
      ->check(CLI::Range(1, 1000))
      ->needs(&simulate)
      ->group(kWithoutPage);
  add_choice(command, "--method", options.method, kAnnotationMethodNames,
             "control-points; rectangle: around the largest error, in the best of six views; best-rectangle: of all "
             "rectangles the one that corrects most")
      ->needs(&simulate)
      ->group(kWithoutPage);
  add_choice(command, "--tens", options.tens, kTensNames,
             "true labels of one ten are parts of one object, as in mOSD (1 to 9: the table); merge, keep, or detect")
      ->needs(&simulate)
      ->group(kWithoutPage);
}

void add_sequence_options(CLI::App& command, AnnotateOptions& options, CLI::Option& simulate) {
  constexpr const char* kSequence{"Sequences"};
  add_value(command, "--poses", options.poses, "FILE",
            "where the clouds were taken, one pose each in their order, from the cloud's coordinates into common ones: "
            "TUM, KITTI or other lists of poses (docs/reference/formats.md); without it, clouds share one frame")
      ->check(CLI::ExistingFile)
      ->group(kSequence);
  command
      .add_flag("--sequence", options.sequence,
                "the clouds of a folder are a sequence: labels mean the same in all and can be carried to the next "
                "cloud, as with --poses and with several clouds")
      ->group(kSequence);
  command
      .add_flag("--carry", options.carry,
                "each cloud takes the labels of the one before it, where it has none, before its lines of the script")
      ->excludes(&simulate)
      ->group(kSequence);
}

bool names_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

void refuse(const fs::path& given, const std::string& option, const std::string& why) {
  if (!given.empty()) usage_error(option, why);
}

}  // namespace

bool AnnotateOptions::of_folder() const { return names_folder(cloud); }

bool AnnotateOptions::of_several() const { return of_folder() || clouds.size() > 1; }

bool AnnotateOptions::is_sequence() const {
  return of_several() && (!of_folder() || sequence || carry || !poses.empty());
}

bool AnnotateOptions::begins_sessions() const {
  return !session.empty() && (!script.empty() || !seeds.empty() || !presets.empty() || carry || opens_page());
}

void add_annotate_options(CLI::App& command, AnnotateOptions& options) {
  add_value(command, "cloud", options.clouds, "CLOUD",
            "point cloud (PCD, PLY, text or KITTI .bin), several of a sequence, or a folder of clouds")
      ->required()
      ->check(CLI::ExistingPath)
      ->each([&options](const std::string& cloud) {
        if (options.cloud.empty()) options.cloud = cloud;
      });
  CLI::Option* simulate =
      add_value(command, "--simulate", options.truth, "TRUTH",
                "true labels of its points (PCD, PLY, .label, .npy, text): a simulated annotator clicks at the centre "
                "of the largest error, again and again. Of a folder: a folder of them, by the same names")
          ->check(CLI::ExistingPath)
          ->group(kWithoutPage);
  add_action_options(command, options, *simulate);
  add_simulation_options(command, options, *simulate);
  add_value(command, "--out", options.out, "FILE",
            "labels: .pcd, .ply, .csv, .xyz, .txt, .label or .npy; of several: a folder. Of the page, where its Save "
            "puts them: without it NAME_labels beside the cloud, or the folder labels in a folder");
  add_value(command, "--names", options.names, "FILE", "what the numbers of labels mean: .txt or .json");
  add_value(command, "--picture", options.picture, "FILE",
            "the cloud in the colours of its labels, with control points: .png; of several: a folder")
      ->group(kWithoutPage);
  add_value(command, "--boxes", options.boxes, "FILE",
            "an upright box around each label, turned about the vertical: .json, or .txt as KITTI's label_2; of a "
            "sequence: a folder")
      ->group(kWithoutPage);
  add_choice(command, "--boxes-as", options.boxes_as, kBoxFormatNames, "format of boxes around several clouds' labels")
      ->group(kWithoutPage);
  add_sequence_options(command, options, *simulate);
  command.option_defaults()->group(kGraph);
  add_graph_options(command, options);
  add_as_printed(command, options);
  add_room_options(command, options.room);
  command.option_defaults()->group("The page");
  command.add_flag("--page", options.page,
                   "opens the page, as it opens where none of --script, --session, --seeds and --simulate is given: "
                   "with --session or --seeds, to go on with these there");
  add_value(command, "--tiles-above", options.tiles_above_points, "N",
            "larger clouds are sent in tiles, which the page asks for where it looks; smaller ones at once")
      ->check(check_whole_number);
  add_serve_options(command, options.serve);
}

void check_annotate_options(const AnnotateOptions& options) {
  if (const Status valid = options.graph.validate(); !valid) throw CLI::ValidationError{valid.error().message};
  if (options.opens_page()) {
    constexpr const char* kNoPage{"is done without the page; leave the page's options (--page, --port, ...) out"};
    refuse(options.truth, "--simulate", kNoPage);
    refuse(options.script, "--script", kNoPage);
    refuse(options.picture, "--picture", "goes with --script, --session, --seeds or --simulate, without the page");
    refuse(options.margins, "--margins", "goes with --script, --session or --seeds, without the page");
    refuse(options.boxes, "--boxes", "goes with --script, --session, --seeds or --simulate, without the page");
    if (options.carry) usage_error("--carry", "is done without the page; there, labels are carried by a button");
  }
  if (!options.names.empty() && options.names.extension() != ".txt" && options.names.extension() != ".json") {
    usage_error("--names", "is a .txt or a .json");
  }
  if (!options.margins.empty() && options.margins.extension() != ".pcd" && options.margins.extension() != ".ply") {
    usage_error("--margins", "is a .pcd or a .ply");
  }
  const bool is_box_file = options.boxes.extension() == ".json" || options.boxes.extension() == ".txt";
  if (!options.boxes.empty() && !options.of_several() && !is_box_file) {
    usage_error("--boxes", "is a .json, or a .txt in KITTI's format");
  }
  if (!options.of_several()) {
    constexpr const char* kSeveral{"is for several clouds, or a folder of them"};
    refuse(options.poses, "--poses", kSeveral);
    if (options.sequence) usage_error("--sequence", kSeveral);
    if (options.carry) usage_error("--carry", kSeveral);
    return;
  }
  if (options.clouds.size() > 1 && std::any_of(options.clouds.begin(), options.clouds.end(), names_folder)) {
    usage_error("cloud", "is one folder, or files");
  }
  if (!options.is_sequence()) {
    constexpr const char* kOne{"is for one cloud or a sequence (--sequence, --poses), not for a folder"};
    refuse(options.script, "--script", kOne);
    if (!options.opens_page()) refuse(options.presets, "--presets", kOne);
    refuse(options.boxes, "--boxes", kOne);
  }
  refuse(options.margins, "--margins", "is for one cloud, not for several");
  refuse(options.names, "--names", "is for one cloud, not for several");
}

}  // namespace saccade::cli
