#include "view/live/live_page.h"

#include <initializer_list>
#include <utility>

#include <nlohmann/json.hpp>

#include "view/common/page_assets.h"
#include "view/common/scene_model.h"

namespace buoyancy {
namespace {

// "model": as scene_model() has it, "version".
std::string model_text(const Scene& scene, const std::string& version) {
  const nlohmann::ordered_json whole{{"version", version}, {"model", scene_model(scene)}};
  return whole.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace

Expected<std::vector<StaticResource>> live_page(const Scene& scene, const std::string& version,
                                                const std::filesystem::path& three) {
  Expected<std::string> three_text = three_js(three);
  if (!three_text) return tl::unexpected(three_text.error());
  std::vector<StaticResource> texts{
      {"/", "text/html; charset=utf-8", std::string(page_text("live.html"))},
      {"/model", "application/json", model_text(scene, version)},
      {"/three.js", "text/javascript; charset=utf-8", std::move(*three_text)},
  };
  const auto add = [&texts](const char* content_type, std::initializer_list<const char*> names) {
    for (const char* name : names) {
      std::string path = "/";
      path += name;
      texts.push_back({std::move(path), content_type, std::string(page_text(name))});
    }
  };
  add("text/javascript; charset=utf-8", {"format.js", "water_scene.js", "plots.js", "live.js"});
  add("text/css; charset=utf-8", {"style.css", "live.css"});
  return texts;
}

}  // namespace buoyancy
