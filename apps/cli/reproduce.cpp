// SPDX-License-Identifier: Apache-2.0
// saccade reproduce TABLE…: tables and figures of the thesis beside those of Saccade.
#include "reproduce.hpp"

#include <CLI/CLI.hpp>
#include <memory>

#include "add_value.hpp"
#include "options.hpp"
#include "reproduce/hand_data_address.hpp"
#include "saccade/scene/rendered_sequence.hpp"

namespace saccade::cli {
namespace {

void add_selection(CLI::App& command, ReproduceArguments& arguments) {
  add_value(command, "tables", arguments.numbers, "TABLE",
            "tables and figures by their number, 2.9 or 3.17; fig-4.5 where a table has that number, too; none: lists "
            "them");
  command.add_flag("--all", arguments.all, "make all tables and figures that the data given allow");
  command.add_flag("--list", arguments.list, "list all tables and figures with their titles and how long they take");
  command.add_flag("--quick", arguments.options.quick,
                   "make each table in about a minute, of fewer frames, poses, pixels and seeds where they are not "
                   "given; captions and JSON say so");
}

void add_data(CLI::App& command, reproduce::TableOptions& options) {
  add_value(command, "--hands", options.hands, "DIR",
            std::string{"Tables 2.2 to 2.6, Figs. 2.13, 2.14: folder of the thesis' recorded hands, from "} +
                reproduce::kHandDataAddress + " (default: hand-polhemus-dataset in the current folder)");
  add_value(command, "--clouds", options.clouds, "DIR",
            "Tables 4.5, 4.6, 4.8, Figs. 4.20, 4.21: folder of clouds that hold labels or have files of labels beside "
            "them, such as mOSD (default: simulated ones)")
      ->check(CLI::ExistingDirectory);
}

void add_sizes(CLI::App& command, reproduce::TableOptions& options) {
  add_value(command, "--poses", options.poses, "N",
            "evaluate only N of the view poses of Table 2.9: quicker, but no longer what the thesis did (default: all)")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1000000}));
  add_value(command, "--image-width", options.image_width_px, "PIXELS",
            "width of the images of Tables 2.7, 2.8, 3.1 to 3.3, 4.1, 4.3, their figures, and of simulated clouds: "
            "quicker, but no longer what the thesis did (default: 640, and 512 in chapter 3)")
      ->check(CLI::Range(16, 640));
  add_value(command, "--noise-seeds", options.noise_seeds, "N",
            "Table 2.4: seeds of the noise that it sums over, from --seed on")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1000000}));
  add_value(command, "--frames", options.frames, "N",
            "scan of Table 2.1: only its first N frames; scenes of surfels in chapter 4: N frames along the same way; "
            "for a quick look (default: all)")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1000000}));
  const auto take_scene = [&options](const std::string& name) { options.surfel_scene = name; };
  add_words(command, "--scene", kSurfelScenes, take_scene,
            "Tables 4.1, 4.3, 4.gain and Figs. 4.10, 4.11: this scene alone; all frames of one take minutes");
  add_value(command, "--placements", options.placements, "N",
            "surfels of chapter 4: places of the grid of seeds in which SV-LCCP is carried out; its figures depend on "
            "them, and are taken together")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1000}));
  command.add_flag(
      "--as-printed", options.as_printed,
      "without the additions of Saccade: the updates of Tables 2.7 and 2.8 as the thesis prints them, and mode "
      "filter and segmentation of Tables 4.1 to 4.3 and their figures");
}

void add_outputs(CLI::App& command, ReproduceArguments& arguments) {
  add_value(command, "--out", arguments.out, "DIR",
            "folder for plots, pictures, and all tables as a page, report.html");
  command.add_flag("--force", arguments.force, "let --out write among other files");
  add_value(command, "--markdown", arguments.markdown, "FILE", "write the tables as Markdown to a file");
}

/// The options that were given, as they would be given again.
void add_words_of(const CLI::App& command, std::vector<std::string>& words) {
  std::vector<std::string> values;
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0) continue;
    if (option->get_positional()) {
      values.insert(values.end(), option->results().begin(), option->results().end());
    } else if (option->get_items_expected_max() == 0) {
      words.push_back(option->get_name());
    } else {
      for (const std::string& value : option->results()) words.push_back(option->get_name() + "=" + value);
    }
  }
  words.insert(words.end(), values.begin(), values.end());
}

}  // namespace

void add_reproduce(CLI::App& program, const GlobalOptions& global, Action& action) {
  CLI::App* command =
      program.add_subcommand("reproduce", "reproduces tables of the thesis, and shows them beside the original ones");
  auto arguments = std::make_shared<ReproduceArguments>();
  add_selection(*command, *arguments);
  add_data(*command, arguments->options);
  add_sizes(*command, arguments->options);
  add_outputs(*command, *arguments);
  command->callback([&program, command, arguments, &global, &action] {
    add_words_of(program, arguments->words);
    add_words_of(*command, arguments->words);
    arguments->options.seed = global.seed;
    check_reproduce(*arguments, global);
    action = [arguments, &global] { return run_reproduce(*arguments, global); };
  });
}

}  // namespace saccade::cli
