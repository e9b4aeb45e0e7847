// SPDX-License-Identifier: Apache-2.0
#pragma once
// Numbers as text and as JSON, as the commands of saccade write them.

#include "json_output.hpp"
#include "summary.hpp"

namespace saccade::reproduce {

using cli::fixed;
using cli::mebibytes;
using cli::millimetres;
using cli::optional_json;
using cli::percent;

}  // namespace saccade::reproduce
