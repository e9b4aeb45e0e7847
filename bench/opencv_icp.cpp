// SPDX-License-Identifier: Apache-2.0
#include <opencv2/rgbd/depth.hpp>

#include "peers.hpp"

namespace saccade::bench {

struct OpencvIcp::Impl {
  cv::Ptr<cv::rgbd::FastICPOdometry> odometry;
  cv::Ptr<cv::rgbd::OdometryFrame> model;

  [[nodiscard]] static cv::Ptr<cv::rgbd::OdometryFrame> frame(const DepthImage& depth) {
    cv::Mat image(depth.height(), depth.width(), CV_32F);
    std::copy(depth.pixels().begin(), depth.pixels().end(), image.ptr<float>());
    return cv::rgbd::OdometryFrame::create(cv::Mat{}, image);
  }
};

OpencvIcp::OpencvIcp(const PinholeCamera& camera) : impl_{std::make_unique<Impl>()} {
  const cv::Mat K = (cv::Mat_<float>(3, 3) << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  impl_->odometry = cv::rgbd::FastICPOdometry::create(K);
}
OpencvIcp::~OpencvIcp() = default;

void OpencvIcp::set_model(const DepthImage& depth) {
  impl_->model = Impl::frame(depth);
  impl_->odometry->prepareFrameCache(impl_->model, cv::rgbd::OdometryFrame::CACHE_ALL);
}

bool OpencvIcp::align(const DepthImage& depth, Pose& T_model_camera) {
  cv::Ptr<cv::rgbd::OdometryFrame> frame = Impl::frame(depth);
  cv::Mat Rt;
  if (!impl_->odometry->compute(frame, impl_->model, Rt)) return false;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) T_model_camera.matrix()(row, column) = Rt.at<double>(row, column);
  }
  return true;
}

}  // namespace saccade::bench
