/* scene_list.c: the scenes by name, for programs. */
#include <stddef.h>
#include <string.h>

#include "bilinear_oscillator.h"
#include "coaxial_cylinders.h"
#include "cracked_plate.h"
#include "scene.h"

typedef int (*make_scene)(int quick, int with_preload, scene **out);

static int make_bilinear_oscillator(int quick, int with_preload, scene **out) {
    (void)quick; /* there is one size */
    bilinear_oscillator_params params;
    bilinear_oscillator_default(&params);
    params.with_preload = with_preload;
    return bilinear_oscillator_create(&params, out);
}

static int make_cracked_plate(int quick, int with_preload, scene **out) {
    cracked_plate_params params;
    if (quick)
        cracked_plate_quick(&params);
    else
        cracked_plate_paper(&params);
    params.with_preload = with_preload;
    return cracked_plate_create(&params, out);
}

static int make_coaxial_cylinders(int quick, int with_preload, scene **out) {
    coaxial_cylinders_params params;
    if (quick)
        coaxial_cylinders_quick(&params);
    else
        coaxial_cylinders_paper(&params);
    params.with_preload = with_preload;
    return coaxial_cylinders_create(&params, out);
}

static const struct {
    const char *name;
    make_scene make;
} list[] = {{"bilinear_oscillator", make_bilinear_oscillator},
            {"cracked_plate", make_cracked_plate},
            {"coaxial_cylinders", make_coaxial_cylinders}};

int scene_count(void) {
    return (int)(sizeof list / sizeof *list);
}

const char *scene_name(int index) {
    return index >= 0 && index < scene_count() ? list[index].name : NULL;
}

int scene_create(const char *name, const char *size, int with_preload, scene **out) {
    if (!name || !size || !out) return SCENE_ERR_ARGUMENT;
    const int quick = !strcmp(size, "quick");
    if (!quick && strcmp(size, "paper")) return SCENE_ERR_SIZE;
    for (int i = 0; i < scene_count(); i++)
        if (!strcmp(name, list[i].name)) return list[i].make(quick, with_preload != 0, out);
    return SCENE_ERR_NAME;
}
