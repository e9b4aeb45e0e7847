// SPDX-License-Identifier: Apache-2.0
// saccade compare: strategies × scenes × noises × seeds, in one SQLite file that an interrupted comparison goes on
// from.
#include <sstream>
#include <utility>

#include "compare_run.hpp"
#include "compare_shards.hpp"

namespace saccade::cli {
namespace {

class Compare final : public Command {
 public:
  explicit Compare(const Planners& planners) : planners_{&planners} {}

  [[nodiscard]] CommandInfo info() const override {
    return {"compare", "compares strategies in scenes, with means and confidence intervals"};
  }

  void declare(Options& options) override {
    FolderOption folder = campaign_folder();
    folder.required = true;
    options.folder(std::move(folder));
    add_compare_options(options.group(), compare_, *planners_);
  }

  void check(const GlobalOptions& global) override { check_compare_options(compare_, global.planners); }

  [[nodiscard]] Result<Outcome> run(Context& context) override {
    compare_.out = context.out();
    SACCADE_TRY(const Comparison comparison, recorded(context, compare_, Comparison::create(compare_)));
    return run_campaign(context, comparison,
                        [](const Campaign&, const ComparedRuns& compared, nlohmann::json&) -> Result<std::string> {
                          std::ostringstream text;
                          print_comparison(text, compared);
                          return text.str();
                        });
  }

 private:
  const Planners* planners_;
  CompareOptions compare_;
};

}  // namespace

void add_compare(CLI::App& program, const GlobalOptions& global, Action& action) {
  add_command(program, global, action, std::make_shared<Compare>(global.planners));
}

}  // namespace saccade::cli
