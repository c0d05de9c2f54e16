#include "src/sinks/plan_picture.h"

namespace cgsr::sinks {

const cv::Mat& PlanPicture::draw(const ImageReport& report) {
  app::PlanFacts facts;
  if (truth_.image_truth()) facts.truth = *truth_.image_truth();
  facts.found = report.frame.objects.value.first().object.found;
  facts.commanded = report.motion.commanded;
  facts.set_distance_m = set_distance_m_;
  const stages::PoseEstimate& pose = report.frame.pose.value;
  if (pose.has_map && !pose.seeks_pose())
    facts.believed = hal::FloorPose{pose.robot.x_m, pose.robot.y_m, pose.robot.heading_rad};
  return view_.draw(facts);
}

}  // namespace cgsr::sinks
