#include "maps/yaml_quoting.hpp"

#include <yaml-cpp/yaml.h>

namespace lodestar {

std::string yaml_quoted(const std::string& text) {
  YAML::Emitter emitter;
  emitter << YAML::DoubleQuoted << text;
  return emitter.c_str();
}

}  // namespace lodestar
