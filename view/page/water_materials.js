'use strict';
// How hulls and water look. In waves (WAVES), the water's geometry gives its elevation, and that of a hull the heights of
// its vertices over the water; the shaders of water at rest need neither.

// min_line_width of the waterline: relative to `diagonal`, that of the mesh [m].
function hull_material(up, diagonal) {
  const colour = (name) => ({ value: new THREE.Color(WaterScene.colours[name]) });
  return new THREE.ShaderMaterial({
    defines: {},
    extensions: { derivatives: true },
    side: THREE.DoubleSide,
    uniforms: { up: { value: up }, dry: colour('dry'), wet: colour('wet'), waterline: colour('waterline'),
                opacity: { value: 1 },  // only with subdivision
                min_line_width: { value: 0.002 * diagonal } },
    vertexShader: `
      varying vec3 position_W, position_view;
      #ifdef WAVES
        attribute float height_over_water;
        varying float height;
      #endif
      void main() {
        vec4 world = modelMatrix * vec4(position, 1.0);
        vec4 view = viewMatrix * world;
        #ifdef WAVES
          height = height_over_water;
        #endif
        position_W = world.xyz;
        position_view = view.xyz;
        gl_Position = projectionMatrix * view;
      }`,
    // Flat shading, since the solver uses flat faces. The waterline is about two pixels wide at any slope.
    fragmentShader: `
      uniform vec3 up, dry, wet, waterline;
      uniform float min_line_width;
      uniform float opacity;  // only with subdivision
      varying vec3 position_W, position_view;
      #ifdef WAVES
        varying float height;
      #endif
      void main() {
        vec3 normal = normalize(cross(dFdx(position_view), dFdy(position_view)));
        float light = 0.58 + 0.42 * max(0.0, dot(normal, normalize(vec3(-0.4, 0.8, 0.5))));
        #ifndef WAVES
          float height = dot(position_W, up);
        #endif
        float line = max(1.6 * fwidth(height), min_line_width);
        vec3 colour = (height > 0.0 ? dry : wet) * light;
        gl_FragColor = vec4(abs(height) < line ? waterline : colour, 1.0);
        if (abs(height) >= line) gl_FragColor.a = opacity;  // only with subdivision
      }`,
  });
}

// The water, with a grid of lines. vertex_shader: sets point [m], horizontal, and camera_distance [m]; in waves also
// light, the brightness. cell: { value } [m], of the grid; fade: { value } [m], the distance at which the water ends.
function water_material(cell, fade, vertex_shader, defines = {}, uniforms = {}) {
  return new THREE.ShaderMaterial({
    defines,
    extensions: { derivatives: true },
    side: THREE.DoubleSide,
    transparent: true,
    depthWrite: false,
    uniforms: { colour: { value: new THREE.Color(WaterScene.colours.water) }, cell, fade, ...uniforms },
    vertexShader: vertex_shader,
    fragmentShader: `
      uniform vec3 colour;
      uniform float cell, fade;
      varying vec2 point;
      varying float camera_distance;
      #ifdef WAVES
        varying float light;
      #else
        const float light = 1.0;
      #endif
      void main() {
        vec2 cells = point / cell;
        vec2 width = fwidth(cells);
        vec2 lines = 1.0 - min(abs(fract(cells - 0.5) - 0.5) / max(width, 1e-6), 1.0);
        float line = max(lines.x, lines.y) * (1.0 - smoothstep(0.1, 0.5, max(width.x, width.y)));
        float clear = 1.0 - smoothstep(0.3 * fade, fade, camera_distance);
        gl_FragColor = vec4(light * mix(colour, 0.45 * colour, 0.5 * line), clear * (0.45 + 0.25 * line));
      }`,
  });
}
