"""Why a planner solves nothing of a suite: {(suite, planner): sentence}. Only what a look at runs has shown."""

# Looked at: m10_bolt_nut and bayonet_mount, 25 s each, and how far the part came (`dismantle explain`).
PLAY = ("it never leaves the play of the assembled state: {how}. Poses that are free beyond it lie on the screw of the thread, or on the one "
        "path of a lock, as thin as the clearance; {extend}")
STRAIGHT = "extensions towards random states leave it at once."


def in_play(far, extend=STRAIGHT):
    return PLAY.format(how=f"on m10_bolt_nut and bayonet_mount its best state came {far} of the largest edge in 25 s", extend=extend)


CAUSES = {
    ("rotational", "rrt"): in_play("0.4 and 0.6 %"),
    ("rotational", "t_rrt"): in_play("0.4 and 0.6 %"),
    ("rotational", "mv_t_rrt"): in_play("0.4 and 0.6 %"),
    ("rotational", "bk_rrt"): "random wrenches turn a nut along its thread, but without a direction: on m10_bolt_nut, whose nut takes ten turns "
                              "to come off, its best state was 51 degrees away after 25 s; on bayonet_mount it never left the play of the "
                              "assembled state (0.6 % of the largest edge).",
    ("rotational", "prm"): in_play("0.2 and 0.6 %"),
    ("rotational", "rrt_connect_removal"): in_play("0.4 and 0.4 %"),
    ("rotational", "tolerant_rrt"): in_play("0.4 and 0.4 %", "growing random steps of translation and rotation leave it at once."),
    ("rotational", "tunnel_forest"): in_play("0.4 and 0.6 %", "each turn of a screw has to be found by chance."),
}
