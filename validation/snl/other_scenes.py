# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts of the report of validation/snl beside the fifteen shots: a slab, three dimensions, code against code. A part of
which no run stands is left out."""

SLAB = {360: 67, 434: 214, 606: 449, 749: 615, 1058: 947}  # m/s before and after, Hanchak et al. 1992, from memory
CONVERT = "failure: {action: convert, when: {plastic_strain: 0.5, jacobian: 0.2}}"
CORE_CELL = 12.7e-3  # m, three in the radius
MESH = f"{{lagrangian_mesh: {{element: {CORE_CELL:g}, {CONVERT}}}}}"
CORE = {  # words: kinematics of the target
    "points, 8 to the cell": "mpm",
    "hexahedra that become points": MESH,
    "particles, 8 to the cell": f"{{sph: {{spacing: {CORE_CELL / 2:g}}}}}",
}


def measure(run, name):
    return run.measure(name) if run else None


def text(number, digits=3):
    return "-" if number is None else f"{number:.{digits}f}"


def cost(run):
    """Energy error per cent, processor seconds, steps."""
    if not run:
        return ["-", "-", "-"]
    return [f"{run.error:.1f}", f"{run.summary['machine']['processor_seconds']:.0f}", run.summary["steps"]]


def run_slab(study, speeds):
    study.use("inputs/snl/slab.yaml")
    laws = {"HJC": ["materials.concrete={card: concrete_48, rate: jaumann}"],
            "K&C": ["materials.concrete=none", "materials.concrete={card: {concrete: {fc: 48 MPa, model: karagozian_case}}, "
                    "density: 2440, rate: jaumann}"]}
    jobs = {f"slab_{law.replace('&', '')}_{v}": ([*settings, f"bodies.projectile.velocity=[0, {-v}]"], 10)
            for law, settings in laws.items() for v in speeds}
    return study.run_all(jobs)


def slab(study, found):
    if not any(found.values()):
        return
    rows = []
    for v, after in SLAB.items():
        row = [v, after]
        for law in ("HJC", "KC"):
            run = found.get(f"slab_{law}_{v}")
            speed = measure(run, "velocity")
            row += [text(-speed if speed else None, 0), *cost(run)[:2]]
        rows.append(row)
    study.add("## Slab of 48 MPa", "[inputs/snl/slab.yaml](../../inputs/snl/slab.yaml): 178 mm, plain and round where the tests had a "
              "reinforced square; 0.5 kg, 25.4 mm, CRH 3, rigid; six cells in the radius. Measured values are from memory and judge nothing.")
    study.add_table(["m/s before", "after, measured", "HJC", "energy error %", "cpu s", "K&C", "energy error %", "cpu s"], rows)


def run_space(study):
    study.use("inputs/snl/tilted.yaml")
    straight = ["bodies.projectile.shape.rotate.angle=0 degree"]
    return {"tilted by 4.38 degree": study.run("half_tilted", [], 230), "straight": study.run("half_straight", straight, 230)}


def space(study, found, section):
    """`section`: the axisymmetric run of shot 10 at the same cell."""
    if not any(found.values()):
        return
    rows = [[words, run.summary["points"] if run else "-", text(measure(run, "depth")), *cost(run)] for words, run in found.items()]
    rows.append(["axisymmetric", section.summary["points"] if section else "-", text(measure(section, "depth")), *cost(section)])
    study.add("## In three dimensions", "Shot 10, HJC, three cells in the radius, half of the scene in three levels of cells: cells of 12.7 mm everywhere "
              "would be 6.3 million points. Measured 0.531 m.")
    study.add_table(["", "points", "depth m", "energy error %", "cpu s", "steps"], rows)


def run_sections(study, tests, names=("16", "04")):
    """Points against elements on one cell everywhere."""
    study.use("inputs/snl/penetration.yaml")
    jobs = {}
    for name in names:
        for law in ("HJC", "K&C"):
            for kind, kinematics in (("points", "mpm"), ("elements", MESH)):
                settings = [*tests[name].settings(law, 3), "grid.refine=none", f"grid.cell={CORE_CELL:g}",
                            f"bodies.target.kinematics={kinematics}"]
                jobs[f"section_{kind}_{law.replace('&', '')}_{name}_3"] = (settings, 20)
    return study.run_all(jobs)


def sections(study, tests, found):
    if not any(found.values()):
        return
    rows = []
    for key, run in found.items():
        _, kind, law, name, cells = key.split("_")
        contact = 100 * run.audit("contact_heat") / run.audit("initial_energy") if run else None
        became = run.audit("converted_elements") if run and kind == "elements" else "-"
        rows.append([f"{name}, {law}, {cells} cells, {kind}", text(measure(run, "depth")),
                     f"{100 * (measure(run, 'depth') / tests[name].measured - 1):+.1f}" if run else "-",
                     *cost(run), text(contact, 1), became])
    study.add("## Code against code, one set of kernels", "The same laws on points and on quadrilaterals that become points (at a plastic strain of 0.5 "
              "or a corner's Jacobian of 0.2: the one threshold here, ours), axisymmetric, one cell everywhere (no levels: elements have none).")
    study.add_table(["shot", "depth m", "error %", "energy error %", "cpu s", "steps", "contact heat %", "became points"], rows)


def run_cores(study):
    study.use("inputs/snl/three_kinematics.yaml")
    return {words: study.run("core_" + words.split(",")[0].split()[0], [f"bodies.target.kinematics={kinematics}", "time.end=0.5 ms"], 200, study.cores)
            for words, kinematics in CORE.items()}


def cores(study, found):
    if not any(found.values()):
        return
    rows = []
    for words, run in found.items():
        speed = run.history()["projectile.mean_velocity_z"][-1] if run else None
        rows.append([words, run.summary["points"] if run else "-", text(measure(run, "depth")), text(speed, 1), *cost(run)])
    study.add("The three in 3D, a quarter: shot 16 into a core of 0.3 m ([three_kinematics.yaml](../../inputs/snl/three_kinematics.yaml)), HJC, the first "
              "half millisecond, which particles can pay for.")
    study.add_table(["target of", "carriers", "depth m at 0.5 ms", "velocity m/s", "energy error %", "cpu s", "steps"], rows)
