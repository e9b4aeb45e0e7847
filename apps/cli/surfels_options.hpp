// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfelsOptions: the command line of `saccade surfels`, and what it means for the library.

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>

#include "frame_options.hpp"
#include "loop_mode.hpp"
#include "saccade/core/names.hpp"
#include "saccade/surfel/mode_filter.hpp"
#include "saccade/surfel/surfel_fusion.hpp"

namespace CLI {
class App;
}

namespace saccade::cli {

/// What is written: the colours that the mode filter chose, averages, or both.
enum class ModeFilterUse { on, off, both };
inline constexpr auto kModeFilterUseNames =
    make_names<ModeFilterUse>({{ModeFilterUse::on, "on"}, {ModeFilterUse::off, "off"}, {ModeFilterUse::both, "both"}});

/// Which of its colours a surfel has in the end.
enum class ModeChoice { sharpened, densest, heaviest };
inline constexpr auto kModeChoiceNames = make_names<ModeChoice>(
    {{ModeChoice::sharpened, "sharpened"}, {ModeChoice::densest, "densest"}, {ModeChoice::heaviest, "heaviest"}});

/// Where a surfel is.
enum class SurfelPlaces { average, modes };
inline constexpr auto kSurfelPlacesNames =
    make_names<SurfelPlaces>({{SurfelPlaces::average, "average"}, {SurfelPlaces::modes, "modes"}});

/// Words of --loops: surfels are fused again once all loops are known.
inline constexpr auto kSurfelLoopNames = make_some_names<LoopMode>({{LoopMode::off, "off"}, {LoopMode::end, "end"}});

/// Surface that --tracking rgbd aligns frames to: the surfels, or a TSDF map of the same frames.
enum class TrackedSurface { surfels, map };
inline constexpr auto kTrackedSurfaceNames =
    make_names<TrackedSurface>({{TrackedSurface::surfels, "surfels"}, {TrackedSurface::map, "map"}});

struct SurfelsOptions : FrameOptions {
  std::filesystem::path out;
  std::filesystem::path picture;
  ModeFilterUse mode_filter{ModeFilterUse::on};
  std::optional<double> min_confidence;  ///< default: min_weight
  bool exposure_compensation{false};
  TrackedSurface track_against{TrackedSurface::surfels};
  LoopMode loops{LoopMode::off};
  ModeChoice choice{ModeChoice::sharpened};
  bool as_printed{false};              ///< Algorithm 6 and eq. 4.11 to the letter, where no option says otherwise
  std::optional<SurfelPlaces> places;  ///< default: as the choice needs it
  SurfelFusionConfig fusion;
  ModeFilterConfig filter;

  [[nodiscard]] bool filtered() const { return mode_filter != ModeFilterUse::off; }
  /// Guided depths go into the modes' places alone.
  [[nodiscard]] bool places_of_modes() const {
    return places ? *places == SurfelPlaces::modes : choice == ModeChoice::heaviest;
  }
  /// Where the averages go: nowhere, to --out, or beside it.
  [[nodiscard]] std::filesystem::path average_out() const {
    if (mode_filter == ModeFilterUse::on) return {};
    if (mode_filter == ModeFilterUse::off) return out;
    std::filesystem::path beside = out;
    return beside.replace_extension(".average" + out.extension().string());
  }
  /// Returns the least w_s that is written after `fused` frames. ElasticFusion shows surfels of a confidence above 10;
  /// fewer than 200 frames do not see things that often.
  [[nodiscard]] double min_weight(std::size_t fused) const {
    constexpr double kSeenOften{10.0};
    constexpr double kShareOfFrames{0.05};
    return min_confidence.value_or(std::min(kSeenOften, kShareOfFrames * static_cast<double>(fused)));
  }
};

/// Adds the options to the subcommand; `options` outlives the parsing.
void add_surfels_options(CLI::App& command, SurfelsOptions& options);
/// Checks the options together, once all are known, and which of them were given; throws usage errors. Completes
/// options.fusion and options.filter.
void check_surfels_options(const CLI::App& command, SurfelsOptions& options);

}  // namespace saccade::cli
