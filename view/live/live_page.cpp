#include "view/live/live_page.h"

#include <initializer_list>
#include <utility>

#include "view/common/body_statuses.h"
#include "view/common/scene_model.h"
#include "view/page/page_assets.h"

namespace buoyancy::view {
namespace {

// "version", "body_statuses": see body_statuses(), "model": see scene_model().
std::string model_json(const Scene& scene, const std::string& version) {
  return json_line(
      Json{{"version", version}, {"body_statuses", body_statuses()}, {"model", scene_model(scene)}});
}

// Joins all scripts: a browser opens a connection per file, and gives up one that a busy machine serves late.
std::string page_script(bool subdivision) {
  std::string script;
  std::vector<const char*> names{"format.js",       "sea.js",         "water_materials.js",
                                 "wave_surface.js", "water_scene.js", "plots.js",
                                 "loads.js"};
  if (subdivision) names.push_back("subdivision.js");
  names.push_back("live.js");
  for (const char* name : names) {
    script += page_text(name, subdivision);
    script += '\n';
  }
  return script;
}

}  // namespace

Expected<std::vector<StaticResource>> live_page(const Scene& scene, const std::string& version,
                                                const std::filesystem::path& three) {
  Expected<std::string> three_text = three_js(three);
  if (!three_text) return tl::unexpected(three_text.error());
  std::vector<StaticResource> resources{
      {"/", "text/html; charset=utf-8", page_text("live.html")},
      {"/model", "application/json", model_json(scene, version)},
      {"/three.js", "text/javascript; charset=utf-8", std::move(*three_text)},
  };
  const auto add = [&resources](const char* content_type, std::initializer_list<const char*> names) {
    for (const char* name : names) {
      std::string path = "/";
      path += name;
      resources.push_back({std::move(path), content_type, page_text(name)});
    }
  };
  resources.push_back(
      {"/page.js", "text/javascript; charset=utf-8", page_script(scene.bodies_with_subdivision() > 0)});
  add("text/css; charset=utf-8", {"style.css", "live.css"});
  return resources;
}

}  // namespace buoyancy::view
