// SPDX-License-Identifier: Apache-2.0
// saccade show: a run, map, mesh or cloud in the browser.
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>

#include "context.hpp"
#include "serve.hpp"
#include "server/show/open_document.hpp"
#include "server/show/viewer_service.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

std::string document_text(const server::SceneDocument& document) {
  std::ostringstream text;
  const Summary summary{text};
  summary.line("shows", document.title);
  for (const auto& [name, fact] : document.facts) summary.line(name, fact);
  if (!document.steps.empty()) summary.line("steps", std::to_string(document.steps.size()));
  return text.str();
}

class Show final : public Command {
 public:
  [[nodiscard]] CommandInfo info() const override { return {"show", "shows a run, map, mesh or cloud in the browser"}; }

  void declare(Options& options) override {
    options
        .value("subject", subject_, "RUN|MAP|MESH|CLOUD",
               "the folder of a run, a map (.sacmap), a mesh (.ply, .obj, .stl, .glb) or a cloud (.pcd, .ply, .las, "
               ".npy, .xyz, .txt, .csv, .pts, .asc, .bin)")
        .required();
    options.direction("--up", up_, "which way is up (default: told by the files, or guessed from the points)");
    add_serve_options(options.group(), serve_);
  }

  [[nodiscard]] Result<Outcome> run(Context& context) override {
    SACCADE_TRY(document_, server::open_document(subject_, context.executor(), up_));
    context.lap("open");
    SACCADE_TRY(server_, listen(serve_));
    return Outcome{.result = summary_json(document_),
                   .text = context.quiet() ? "" : document_text(document_),
                   .afterwards = [this, &context] { serve_until_interrupted(context.global()); }};
  }

 private:
  void serve_until_interrupted(const GlobalOptions& global) {
    const auto post = [this](std::function<void()> work) { server_->post(std::move(work)); };
    server::ViewerService service{*server_, {SACCADE_VERSION, post}, document_};
    serve(serve_, global, *server_, service);
    server_.reset();  // before the service that it calls
  }

  std::filesystem::path subject_;
  std::optional<Eigen::Vector3d> up_;
  ServeOptions serve_;
  server::SceneDocument document_;
  std::unique_ptr<server::HttpServer> server_;
};

}  // namespace

void add_show(CLI::App& program, const GlobalOptions& global, Action& action) {
  add_command<Show>(program, global, action);
}

}  // namespace saccade::cli
