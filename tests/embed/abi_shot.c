/* Prints the sizes and offsets of shot.h. They must not change without a new SONAME. */
#include <limpid/shot.h>
#include <stddef.h>
#include <stdio.h>

#define STRUCT(type) printf("struct %s %zu\n", #type, sizeof(type))
#define MEMBER(type, member) printf("  %s %zu %zu\n", #member, offsetof(type, member), sizeof(((type*)0)->member))

int main(void) {
    STRUCT(limpid_texts);
    MEMBER(limpid_texts, data);
    MEMBER(limpid_texts, count);
    STRUCT(limpid_shot_desc);
    MEMBER(limpid_shot_desc, size);
    MEMBER(limpid_shot_desc, input);
    MEMBER(limpid_shot_desc, output);
    MEMBER(limpid_shot_desc, denoiser);
    MEMBER(limpid_shot_desc, preset);
    MEMBER(limpid_shot_desc, settings);
    MEMBER(limpid_shot_desc, weights);
    MEMBER(limpid_shot_desc, map);
    MEMBER(limpid_shot_desc, map_file);
    MEMBER(limpid_shot_desc, files);
    MEMBER(limpid_shot_desc, cameras);
    MEMBER(limpid_shot_desc, fps);
    MEMBER(limpid_shot_desc, camera_start);
    MEMBER(limpid_shot_desc, motion);
    MEMBER(limpid_shot_desc, frames);
    MEMBER(limpid_shot_desc, shard);
    MEMBER(limpid_shot_desc, cuts);
    MEMBER(limpid_shot_desc, on_error);
    MEMBER(limpid_shot_desc, exposure);
    MEMBER(limpid_shot_desc, strength);
    MEMBER(limpid_shot_desc, preserve);
    MEMBER(limpid_shot_desc, bidirectional);
    MEMBER(limpid_shot_desc, resume);
    MEMBER(limpid_shot_desc, progress);
    MEMBER(limpid_shot_desc, progress_user);
    MEMBER(limpid_shot_desc, recover);
    STRUCT(limpid_shot_summary);
    MEMBER(limpid_shot_summary, size);
    MEMBER(limpid_shot_summary, frames);
    MEMBER(limpid_shot_summary, kept);
    MEMBER(limpid_shot_summary, skipped);
    MEMBER(limpid_shot_summary, cuts);
    MEMBER(limpid_shot_summary, stopped);
    MEMBER(limpid_shot_summary, seconds);
    return 0;
}
