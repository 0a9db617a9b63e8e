// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <type_traits>
#include <vector>

#include "shapemap/core/options.hpp"
#include "shapemap/mapper/map_result.hpp"
#include "shapemap/matching/scan_match.hpp"

/// Several JSON files have these parts in common. Numbers that are not finite become null.
namespace shapemap {

using Json = nlohmann::ordered_json;

Json number_json(double value);

/// The array is [x_m, y_m, theta_rad].
Json pose_array(const Pose2& pose);
Json pose_arrays(const std::vector<Pose2>& poses);

/// The rows are those of (x [m], y [m], theta [rad]).
Json covariance_json(const Eigen::Matrix3d& covariance);

Json ranked_json(const RankedPose& ranked);

/// Returns a value in the unit of the option's name, without the last bits, which converting there and back changes.
double shown(double stored, double unit);

/// Adds each option of `options` by its name.
template <class Options>
void add_options(const Options& options, Json& all) {
  Options::fields(options, [&](const Field& field, const auto& value) {
    using Value = std::decay_t<decltype(value)>;
    if constexpr (std::is_enum_v<Value>) {
      all[field.name] = enum_name(value);
    } else if constexpr (std::is_same_v<Value, double>) {
      all[field.name] = shown(value, field.unit);
    } else {
      all[field.name] = value;
    }
  });
}

}  // namespace shapemap
