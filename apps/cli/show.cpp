// SPDX-License-Identifier: Apache-2.0
// saccade show: a run, map, mesh or cloud in the browser.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>

#include "add_value.hpp"
#include "json_output.hpp"
#include "saccade/core/clock.hpp"
#include "serve.hpp"
#include "server/show/open_document.hpp"
#include "server/show/viewer_service.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

struct ShowOptions {
  std::filesystem::path subject;
  ServeOptions serve;
};

void print_document(const server::SceneDocument& document) {
  const Summary summary{std::cout};
  summary.line("shows", document.title);
  for (const auto& [name, text] : document.facts) summary.line(name, text);
  if (!document.steps.empty()) summary.line("steps", std::to_string(document.steps.size()));
}

Result<int> run_show(const ShowOptions& options, const GlobalOptions& global) {
  const Stopwatch stopwatch;
  const Executor executor = global.executor();
  SACCADE_CHECK(check_json_output(global));
  SACCADE_TRY(const server::SceneDocument document, server::open_document(options.subject, executor));
  SACCADE_TRY(std::unique_ptr<server::HttpServer> server, listen(options.serve));
  SACCADE_CHECK(write_result("show", global, executor, {{"open", stopwatch.elapsed_ms()}}, summary_json(document)));
  if (!global.json_to_stdout() && !global.quiet) print_document(document);
  const auto post = [&server](std::function<void()> work) { server->post(std::move(work)); };
  server::ViewerService service{*server, {SACCADE_VERSION, post}, document};
  const int status = serve(options.serve, global, *server, service);
  server.reset();  // before the service that it calls
  return status;
}

}  // namespace

void add_show(CLI::App& program, const GlobalOptions& global, Action& action) {
  CLI::App* command = program.add_subcommand("show", "shows a run, map, mesh or cloud in the browser");
  auto options = std::make_shared<ShowOptions>();
  add_value(*command, "subject", options->subject, "RUN|MAP|MESH|CLOUD",
            "the folder of a run, a map (.sacmap), a mesh (.ply, .obj, .stl, .glb) or a cloud (.pcd, .ply, .xyz, .txt, "
            ".csv, .pts, .bin)")
      ->required();
  add_serve_options(*command, options->serve);
  command->callback(
      [options, &global, &action] { action = [options, &global] { return run_show(*options, global); }; });
}

}  // namespace saccade::cli
