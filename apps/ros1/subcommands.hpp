// SPDX-License-Identifier: Apache-2.0
#pragma once
// Nodes of saccade-ros1, one source file each. Each returns the program's exit status.

int run_kinfu(int argc, char** argv);
int run_surfel_next_best_view(int argc, char** argv);
int run_basic_next_best_view(int argc, char** argv);

// Programs of devices, which saccade starts itself (ros:NAME in a cell).
int run_camera_device(int argc, char** argv);
int run_joints_device(int argc, char** argv);
int run_hand_device(int argc, char** argv);

/// Publishes messages that saccade writes to its input (--publish ros).
int run_publish(int argc, char** argv);
