#version 460
// Traces one noisy frame of a moving scene, with the guide layers for a denoiser. One path per pixel: the visible
// surface, then one diffuse bounce in a random direction. The sky has a small sun, which few paths hit.
layout(local_size_x = 8, local_size_y = 8) in;

const int radianceOut = 0;  // scattered light including albedo; the sky
const int albedoOut = 1;    // 1 where nothing is hit
const int normalOut = 2;    // world space, mapped from [-1, 1] to [0, 1]
const int depthOut = 3;     // distance from the eye; 0 where nothing is hit
const int motionOut = 4;    // previous minus current position, pixels
layout(binding = 0) uniform writeonly image2D layers[5];

layout(push_constant) uniform Push {
    uint frame;
};
const float focal = 2.0;  // 1 / tan(half the vertical angle of view)

/// Returns the camera's position. It looks along -z and moves sideways.
vec3 eyeAt(float t) {
    return vec3(0.8 * sin(t), 1.2, 5.0);
}

const int sphereCount = 4, ground = sphereCount, nothing = -1;
const vec3 colors[5] = vec3[5](vec3(0.9, 0.3, 0.2), vec3(0.2, 0.6, 0.9), vec3(0.3, 0.8, 0.3), vec3(0.9, 0.8, 0.3),
                               vec3(0.5));

/// Returns centre and radius of a sphere. All spheres circle around the origin, and the first one jumps.
vec4 sphere(int i, float t) {
    const float angle = 1.57 * i + 0.6 * t;
    const float height = i == 0 ? 0.5 + abs(sin(3.0 * t)) : 0.5;
    return vec4(1.4 * cos(angle), height, 1.4 * sin(angle), 0.5);
}

/// Returns the first object that a ray hits, and its distance.
int trace(vec3 origin, vec3 direction, float time, out float distance) {
    int hit = nothing;
    distance = 1e9;
    if (direction.y < 0.0) {
        hit = ground;
        distance = -origin.y / direction.y;
    }
    for (int i = 0; i < sphereCount; ++i) {
        const vec4 s = sphere(i, time);
        const vec3 toCentre = s.xyz - origin;
        const float along = dot(toCentre, direction);
        const float inside = s.w * s.w - dot(toCentre, toCentre) + along * along;
        const float t = along - sqrt(max(inside, 0.0));
        if (inside > 0.0 && t > 1e-3 && t < distance) {
            hit = i;
            distance = t;
        }
    }
    return distance < 30.0 ? hit : nothing;
}

vec3 sky(vec3 direction) {
    const vec3 sun = dot(direction, normalize(vec3(0.5, 0.6, 0.4))) > 0.96 ? vec3(9.0, 7.5, 5.5) : vec3(0.0);
    return sun + mix(vec3(0.5, 0.6, 0.7), vec3(0.15, 0.3, 0.6), clamp(direction.y, 0.0, 1.0));
}

/// PCG (M. Jarzynski and M. Olano, "Hash Functions for GPU Rendering", JCGT 2020).
float random(inout uint state) {
    state = state * 747796405u + 2891336453u;
    const uint word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;
    return float(((word >> 22) ^ word) >> 8) / 16777216.0;
}

/// Samples a cosine-weighted direction: towards a random point of the unit sphere that touches the surface.
vec3 bounce(vec3 normal, inout uint state) {
    const float z = 2.0 * random(state) - 1.0, angle = 6.2831853 * random(state);
    return normalize(normal * 1.0001 + vec3(sqrt(1.0 - z * z) * vec2(cos(angle), sin(angle)), z));
}

/// Projects a point, relative to the camera, to pixel coordinates.
vec2 project(vec3 fromEye, vec2 size) {
    const vec2 clip = focal * vec2(fromEye.x * size.y / size.x, -fromEye.y) / -fromEye.z;
    return (0.5 * clip + 0.5) * size;
}

void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    const vec2 size = vec2(imageSize(layers[radianceOut]));
    if (any(greaterThanEqual(at, ivec2(size)))) return;
    const float time = frame / 30.0, previousTime = (frame - 1.0) / 30.0;
    const vec3 eye = eyeAt(time);
    const vec2 onScreen = (2.0 * (vec2(at) + 0.5) - size) / size.y;
    const vec3 direction = normalize(vec3(onScreen.x, -onScreen.y, -focal));

    float distance;
    const int hit = trace(eye, direction, time, distance);
    if (hit == nothing) {
        imageStore(layers[radianceOut], at, vec4(sky(direction), 1.0));
        imageStore(layers[albedoOut], at, vec4(1.0));
        imageStore(layers[normalOut], at, vec4(0.5));
        imageStore(layers[depthOut], at, vec4(0.0));
        imageStore(layers[motionOut], at, vec4(0.0));
        return;
    }
    const vec3 position = eye + distance * direction;
    const vec4 s = sphere(hit, time);
    const vec3 normal = hit == ground ? vec3(0.0, 1.0, 0.0) : normalize(position - s.xyz);

    uint state = uint(at.x) + 65536u * uint(at.y);
    random(state);
    state ^= 9781u * frame;
    const vec3 onward = bounce(normal, state);
    float further;
    const int second = trace(position + 1e-3 * normal, onward, time, further);
    // An approximation: the second surface receives the mean light of the sky.
    const vec3 light = second == nothing ? sky(onward) : 0.5 * colors[second];

    // The surface point's movement since the previous frame. The spheres do not rotate.
    const vec3 moved = hit == ground ? vec3(0.0) : sphere(hit, previousTime).xyz - s.xyz;
    const vec2 motion = project(position + moved - eyeAt(previousTime), size) - project(position - eye, size);

    imageStore(layers[radianceOut], at, vec4(colors[hit] * light, 1.0));
    imageStore(layers[albedoOut], at, vec4(colors[hit], 1.0));
    imageStore(layers[normalOut], at, vec4(0.5 * normal + 0.5, 0.0));
    imageStore(layers[depthOut], at, vec4(distance));
    imageStore(layers[motionOut], at, vec4(motion, 0.0, 0.0));
}
