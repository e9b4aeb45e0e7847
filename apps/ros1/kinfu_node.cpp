// SPDX-License-Identifier: Apache-2.0
#include "subcommands.hpp"

#include <ros/ros.h>

int run_kinfu(int argc, char** argv) {
  ros::init(argc, argv, "kinfu");
  ros::NodeHandle node{"~"};
  ros::spin();
  return 0;
}
