#version 330 core
// Places, zooms and wipes finished pictures (display conversion is done before): nearest texels with edges one screen
// pixel wide above 1:1, the mean over a pixel's footprint below, and a grid between texels when they are large.
uniform sampler2D uLeft, uRight;
uniform vec2 uViewportCorner;  // left and top edge of the pane in the framebuffer, pixels
uniform float uTargetHeight;   // of the framebuffer
uniform vec2 uOrigin;          // where the picture's top-left corner is in the pane, pixels
uniform float uZoom;           // screen pixels a texel
uniform float uWipe;           // from this x in the pane on, uRight is shown
uniform float uGrid;           // opacity of the lines between texels
uniform vec4 uSurround;        // colour beside the picture
out vec4 oColour;

const int kMaxTaps = 16;

vec3 texel(sampler2D image, ivec2 at, ivec2 size) {
    return texelFetch(image, clamp(at, ivec2(0), size - 1), 0).rgb;
}

vec3 magnified(sampler2D image, vec2 at, ivec2 size) {
    vec2 cell = floor(at - 0.5);
    vec2 blend = clamp((at - 0.5 - cell - 0.5) * uZoom + 0.5, 0.0, 1.0);
    ivec2 i = ivec2(cell);
    vec3 top = mix(texel(image, i, size), texel(image, i + ivec2(1, 0), size), blend.x);
    vec3 bottom = mix(texel(image, i + ivec2(0, 1), size), texel(image, i + ivec2(1, 1), size), blend.x);
    return mix(top, bottom, blend.y);
}

vec3 minified(sampler2D image, vec2 at, ivec2 size) {
    float footprint = 1.0 / uZoom;
    vec2 low = at - 0.5 * footprint, high = at + 0.5 * footprint;
    ivec2 first = ivec2(floor(low));
    ivec2 count = min(ivec2(ceil(high)) - first, ivec2(kMaxTaps));
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int y = 0; y < count.y; ++y)
        for (int x = 0; x < count.x; ++x) {
            vec2 corner = vec2(first + ivec2(x, y));
            vec2 covered = max(min(high, corner + 1.0) - max(low, corner), 0.0);
            float weight = covered.x * covered.y;
            sum += weight * texel(image, ivec2(corner), size);
            weights += weight;
        }
    return sum / max(weights, 1e-6);
}

vec3 shown(sampler2D image, vec2 at, ivec2 size) {
    return uZoom >= 1.0 ? magnified(image, at, size) : minified(image, at, size);
}

void main() {
    vec2 inPane = vec2(gl_FragCoord.x, uTargetHeight - gl_FragCoord.y) - uViewportCorner;
    vec2 at = (inPane - uOrigin) / uZoom;
    bool right = inPane.x >= uWipe;
    ivec2 size = right ? textureSize(uRight, 0) : textureSize(uLeft, 0);
    if (any(lessThan(at, vec2(0.0))) || any(greaterThanEqual(at, vec2(size)))) {
        oColour = uSurround;
        return;
    }
    vec3 colour = right ? shown(uRight, at, size) : shown(uLeft, at, size);
    vec2 toEdge = min(fract(at), 1.0 - fract(at)) * uZoom;
    if (uGrid > 0.0 && min(toEdge.x, toEdge.y) < 0.5) colour = mix(colour, vec3(0.5), uGrid);
    oColour = vec4(colour, 1.0);
}
