// SPDX-License-Identifier: Apache-2.0
#include "subcommands.hpp"

#include <ros/ros.h>

int run_surfel_next_best_view(int argc, char** argv) {
  ros::init(argc, argv, "surfel_next_best_view");
  ros::NodeHandle node{"~"};
  ros::spin();
  return 0;
}
