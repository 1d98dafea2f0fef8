#include "app/viewers/foxglove_schemas.hpp"

#include <map>
#include <nlohmann/json.hpp>

namespace lodestar {
namespace {

using Json = nlohmann::ordered_json;

Json of_type(const char* type) {
  return {{"type", type}};
}

const Json number = of_type("number");
const Json integer = of_type("integer");
const Json text = of_type("string");
const Json truth_value = of_type("boolean");
const Json bytes = {{"type", "string"}, {"contentEncoding", "base64"}};

Json list_of(const Json& items) {
  return {{"type", "array"}, {"items", items}};
}

Json object(const Json& properties) {
  return {{"type", "object"}, {"properties", properties}};
}

const Json time_of_day = object({{"sec", integer}, {"nsec", integer}});
const Json vector2 = object({{"x", number}, {"y", number}});
const Json vector3 = object({{"x", number}, {"y", number}, {"z", number}});
const Json quaternion = object({{"x", number}, {"y", number}, {"z", number}, {"w", number}});
const Json pose_type = object({{"position", vector3}, {"orientation", quaternion}});
const Json color = object({{"r", number}, {"g", number}, {"b", number}, {"a", number}});

Json scene_update() {
  const Json cube = object({{"pose", pose_type}, {"size", vector3}, {"color", color}});
  const Json cylinder = object({{"pose", pose_type},
                                {"size", vector3},
                                {"bottom_scale", number},
                                {"top_scale", number},
                                {"color", color}});
  const Json label = object({{"pose", pose_type},
                             {"billboard", truth_value},
                             {"font_size", number},
                             {"scale_invariant", truth_value},
                             {"color", color},
                             {"text", text}});
  const Json line = object({{"type", integer},
                            {"pose", pose_type},
                            {"thickness", number},
                            {"scale_invariant", truth_value},
                            {"points", list_of(vector3)},
                            {"color", color},
                            {"colors", list_of(color)},
                            {"indices", list_of(integer)}});
  const Json any = list_of(of_type("object"));  // shapes that we never send
  const Json entity = object({{"timestamp", time_of_day},
                              {"frame_id", text},
                              {"id", text},
                              {"lifetime", time_of_day},
                              {"frame_locked", truth_value},
                              {"metadata", list_of(object({{"key", text}, {"value", text}}))},
                              {"arrows", any},
                              {"cubes", list_of(cube)},
                              {"spheres", any},
                              {"cylinders", list_of(cylinder)},
                              {"lines", list_of(line)},
                              {"triangles", any},
                              {"texts", list_of(label)},
                              {"models", any}});
  const Json deletion = object({{"timestamp", time_of_day}, {"type", integer}, {"id", text}});
  return object({{"deletions", list_of(deletion)}, {"entities", list_of(entity)}});
}

Json grid() {
  const Json field = object({{"name", text}, {"offset", integer}, {"type", integer}});
  return object({{"timestamp", time_of_day},
                 {"frame_id", text},
                 {"pose", pose_type},
                 {"column_count", integer},
                 {"cell_size", vector2},
                 {"row_stride", integer},
                 {"cell_stride", integer},
                 {"fields", list_of(field)},
                 {"data", bytes}});
}

Json point_cloud() {
  const Json field = object({{"name", text}, {"offset", integer}, {"type", integer}});
  return object({{"timestamp", time_of_day},
                 {"frame_id", text},
                 {"pose", pose_type},
                 {"point_stride", integer},
                 {"fields", list_of(field)},
                 {"data", bytes}});
}

Json camera_calibration() {
  return object({{"timestamp", time_of_day},
                 {"frame_id", text},
                 {"width", integer},
                 {"height", integer},
                 {"distortion_model", text},
                 {"D", list_of(number)},
                 {"K", list_of(number)},
                 {"R", list_of(number)},
                 {"P", list_of(number)}});
}

Json drive_schema() {
  return object({{"timestamp", time_of_day},
                 {"x_m", number},
                 {"y_m", number},
                 {"yaw_deg", number},
                 {"position_sigma_mm", number},
                 {"yaw_sigma_deg", number},
                 {"commanded_mps", number},
                 {"commanded_degps", number},
                 {"measured_mps", number},
                 {"measured_degps", number},
                 {"base", text},
                 {"stop", text},
                 {"slowed_by", text}});
}

Json fix_schema() {
  return object({{"timestamp", time_of_day},
                 {"x_m", number},
                 {"y_m", number},
                 {"yaw_deg", number},
                 {"ids", list_of(integer)},
                 {"confidence", number},
                 {"dots", integer},
                 {"residual_px", number},
                 {"accepted", truth_value}});
}

Json estimate_error() {
  return object({{"timestamp", time_of_day},
                 {"position_mm", number},
                 {"yaw_deg", number},
                 {"position_sigma_mm", number},
                 {"yaw_sigma_deg", number}});
}

std::map<std::string, Json, std::less<>> all_schemas() {
  return {
      {"foxglove.FrameTransform", object({{"timestamp", time_of_day},
                                          {"parent_frame_id", text},
                                          {"child_frame_id", text},
                                          {"translation", vector3},
                                          {"rotation", quaternion}})},
      {"foxglove.PoseInFrame", object({{"timestamp", time_of_day}, {"frame_id", text}, {"pose", pose_type}})},
      {"foxglove.PosesInFrame",
       object({{"timestamp", time_of_day}, {"frame_id", text}, {"poses", list_of(pose_type)}})},
      {"foxglove.Grid", grid()},
      {"foxglove.PointCloud", point_cloud()},
      {"foxglove.SceneUpdate", scene_update()},
      {"foxglove.CompressedImage",
       object({{"timestamp", time_of_day}, {"frame_id", text}, {"data", bytes}, {"format", text}})},
      {"foxglove.CameraCalibration", camera_calibration()},
      {"foxglove.Log", object({{"timestamp", time_of_day},
                               {"level", integer},
                               {"message", text},
                               {"name", text},
                               {"file", text},
                               {"line", integer}})},
      {"lodestar.Drive", drive_schema()},
      {"lodestar.Fix", fix_schema()},
      {"lodestar.EstimateError", estimate_error()}};
}

}  // namespace

std::string viewer_schema(std::string_view name) {
  static const auto schemas = all_schemas();
  const auto found = schemas.find(name);
  if (found == schemas.end()) throw std::out_of_range("no schema " + std::string(name));
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", name}};
  schema.update(found->second);
  return schema.dump();
}

}  // namespace lodestar
