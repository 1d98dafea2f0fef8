#pragma once

#include <filesystem>

#include "localization/detection/marker_detector.hpp"
#include "localization/survey/survey_log.hpp"
#include "maps/camera_model.hpp"

namespace lodestar {

/// Reads a folder for a survey: wheels.csv, and dots.csv as a run leaves it, or else images named by their
/// stamps, whose markers are read now. `dot` is the number of a dot's cell, row by row from the top left (Y
/// is 0, O is 12, X is 15). ceiling.csv, where there is one, is how the ceiling moved. The log is named as
/// the folder. Throws InputError with file and line.
SurveyLog load_survey_log(const std::filesystem::path& folder, const CameraModel& camera,
                          const DetectorOptions& of_images = {});

}  // namespace lodestar
