// SPDX-License-Identifier: Apache-2.0
#pragma once
// split_label: the part of a label on one side of a stroke across it. Not in the thesis.

#include <cstdint>
#include <span>
#include <vector>

#include "saccade/annotate/annotation.hpp"
#include "saccade/annotate/selection.hpp"
#include "saccade/core/executor.hpp"

namespace saccade {

/// Part of a label that a stroke separates: the one with fewer points, or the other.
enum class SplitPart { smaller, larger };

struct LabelSplit {
  std::uint32_t label{kNoLabel};      ///< label that was split
  std::vector<std::uint32_t> points;  ///< the part, ascending
};

/// Splits the label that the stroke crosses most on the surface that is seen. Edges of the neighbourhood between its
/// points are cut where the stroke crosses them in the image, however deep they are. A connected part that the cut
/// touches lies on the side on which most of its cut edges end; parts that the cut does not touch belong to neither.
/// @param positions_m  one per point of the annotation; points that are not finite or clipped take no part.
/// @param stroke       line from border to border; its radius does not count.
/// @param given        label that the part will have; it is not split.
/// @return invalid_argument for a bad view or stroke, where no other label is crossed, and where the stroke does not
/// separate it. O(points + edges of the label + their crossings with the stroke). The thread count never changes the
/// result.
[[nodiscard]] Result<LabelSplit> split_label(const Annotation& annotation, std::span<const Eigen::Vector3f> positions_m,
                                             const SelectionView& view, const ScreenStroke& stroke, SplitPart part,
                                             std::uint32_t given, const Executor& executor);

}  // namespace saccade
