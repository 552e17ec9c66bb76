"""Constants that decide how a computation goes, beside `SolverSettings`: what each one is, and why it is what it is.

None of them is part of a problem. Thresholds at which something is refused, warned of or explained stand with their sentences.
"""

# ---- The problem: positions and directions (theory 3 to 5)

#: Share of a slave face's size that bodies may have to go, to and fro, and be taken to be pressed between what stands on both sides:
#: without loads nothing else moves them (theory 6.8).
BETWEEN = 0.1
#: Least part along the normal of a rigid motion that a contact stands in the way of: loads close no contact that the body slides past.
IN_THE_WAY = 0.05
#: Rate of a gap, or a slip, by a rigid motion below which a constraint does not hold that: what differences of positions leave.
HELD = 1e-3
#: Share of a slave face's size by which constraints may be farther from the master than the nearest one, and begin as closed with it: a
#: ring of four elements takes a tenth, and a body that turns farther until something stops it comes to another place (theory 6.8).
NEXT = 0.5
#: Share of a body's size within which control points are one: ends of rings and rows of poles are computed, and meet to round-off.
SAME_POINT = 1e-9
#: Share of a unit vector, or of the size of all, below which there is nothing of it: normals and axes are given to some digits.
NO_PART = 1e-6
#: Bodies that are centred within so many times their size of the origin, and planes given by points as near to them, are computed as they
#: are, to the last bit: at most four bits of positions are lost there. Farther off coordinates count from the bodies' centre (theory 5.10).
NEAR_ORIGIN = 16.0
#: Degrees that a support turns in one load increment at the most (theory 5.2): an increment knows where control points go, and of half a
#: turn or more not which way; a tenth of a turn is far from that, and near enough for Newton's method.
LARGEST_TURN = 36.0
#: Share of the longest load increment down to which one is cut in which a moment lets its plate turn by more: a plate that comes far in
#: a load step does so little by little, and an eighth of half a turn is less; one that snaps does so however short the increment.
#: So is one in which a body falls into itself.
SHORT_OF_SNAPPING = 0.125
#: J at the Gauss points of a body below which it is looked at between them (theory 5.25): where it was turned inside out there, these came
#: to 0.14 or less, and bodies that are pressed as usual stay above 0.6, and are not looked at.
LOOKED_BETWEEN = 0.5
#: Where elements are looked at, by direction: bounds, middles and quarters. At bounds and middles alone, two of those five stay above 0.3,
#: and one comes to its hardly negative J later.
PLACES_BETWEEN = (0.0, 0.25, 0.5, 0.75, 1.0)
#: A body falls whose least J was above this share of one, and comes to less than this share of that in one increment: those five came from
#: 0.50 to 0.88 to at most 0.08 of that; what is pressed by large steps mostly keeps more than 0.4.
FALLEN = 0.25
#: Share of the largest volume of an element, by its coordinates, below which a place has none: at poles, and where two edges are one line.
NO_VOLUME = 0.01
#: Places of a body that are looked at in one go: some ten megabytes, beside two kilobytes an element.
MOST_AT_ONCE = 100_000

#: Angle between the normals of both sides, in radians, above which a C0 line of a master is a kink: joints of arcs are as smooth as their
#: digits, and where normals turn by less, those that are averaged differ from the own ones by next to nothing.
KINK_ANGLE = 1e-3
#: Share of an element beside a line where its sides are asked for their normals: these turn by about as much on the way.
BESIDE_A_LINE = 1e-6
#: Share of an element within which a constraint's point is on a line between elements: places are means of knots, to round-off.
ON_A_LINE = 1e-9
#: Largest distance of the extrema of Chebyshev splines from one (theory 10.6): far more digits than a place of a constraint needs.
CHEBYSHEV_LEVEL = 1e-12
#: Steps to get there: the exchange converges quadratically from Greville's abscissae, and has taken 5 to 8 on graded and repeated knots.
CHEBYSHEV_STEPS = 50
#: Share of the largest area below which a function has none at the constraints (theory 10.8): it is zero there, but for round-off.
NO_SHARE = 1e-9
#: How far masters go on beyond their edges for constraints at points, as a share of the outer elements (theory 10.7): points on an edge of
#: the slave often lie on the master's, and the least tilt of a face would have them come and go from one iteration to the next.
BRIM = 0.05
#: Control value of a function of lower order, of size one, that is zero but for round-off (theory 2.12).
NO_ENTRY = 1e-12
#: Share of the largest coordinate that bodies have to be apart by, so that they are: round-off of positions is no distance.
CLEAR = 1e-8
#: How near to a knot line of the master, as a share of its shortest element, places count as on it: beside a line by less than the root of
#: round-off its elements are as near as each other, and chance decides.
ON_LINE = 1e-7
#: How near to the bounds of cells, as a share of the slave's element, knot lines of the master are left alone (theory 10.9).
CELL_MARGIN = 1e-5
#: Lines of a cell along which these are looked for, as shares of it: where the middle one meets none, the edges count.
CELL_LINES = ((0.5,), (0.0, 1.0))
#: Places along the middle line of an element at which the lines that cross it are counted: more than 16 are not told apart.
CELL_PLACES = 17
#: Halvings by which a crossing is found: more than a number has bits, so that round-off ends them.
CELL_HALVINGS = 50

# ---- Load increments (theory 5)

#: Newton loops of at most so many linear solves let a cut load increment grow back: they were no harder than usual.
EASY_ITERATIONS = 12
#: Loops of so many tangents make the next increment shorter: a few more, and this one would have been cut (`max_iterations`: 30).
HARD_TANGENTS = 25
#: Halvings of a load step that may be asked for (`max_cuts`): thirty are to a billionth, where load times still tell increments apart.
MOST_CUTS = 30
#: Load steps before the end of one that an increment still ends there: times are sums of increments, to round-off.
SAME_TIME = 1e-12

#: Sums of squares of forces between these are what they should be: what is twenty digits smaller than the largest force has a square, too,
#: and none overflowed. Forces with others are brought to size and squared again.
SQUARED = (1e-80, 1e80)

# ---- Newton's method (theory 6.5, 6.6, 7.5)

#: Factors are kept as long as a solve with them leaves at most this share of the residual: it saves the tangents and their factors, most
#: of an iteration, and each such solve makes the next one better. Those of bodies are, as long as they miss no more of it (theory 5.24).
KEPT_SHARE = 0.7
#: The same where states changed, and with them what the factors are of, or far from a solution: with more, what loads close first opens
#: again, and large load steps take a third more tangents and are cut.
KEPT_FAR = 0.2
#: What is left at most near a solution, relative: of 0.3, twenty scenes of large load steps took 4 % longer.
NEAR_SOLUTION = 0.1
#: So many steps correct solves with kept factors at most: eight take a few more solves, twenty as many and more tangents.
MAX_SECANTS = 12
#: A step does so if this share of what it changed is in none of later ones: of less, round-off would count.
NEW_DIRECTION = 1e-3
#: Iterations that find the active set: before, states may return and what is left may grow without an update being halved.
ACTIVE_SET_ITERATIONS = 5
#: How often an update is halved: a shorter load increment helps more than an update of less than a thirtieth.
MAX_HALVINGS = 5
#: Iterations in a row that are those of one or two before: Newton's method goes round in a circle, and further tangents are in vain. Of 275
#: loops that converged, and 353 that did not, as of penalties and elastic slips that are far too stiff, this ended none of the former,
#: and took a third of all tangents from the latter.
CIRCLING = 4
#: The last iterates in which a front gets on, of what is active or slips: then a loop has more tangents than are allowed else.
ADVANCING = 10
#: What is left, in all of these, below which a loop has as many more: belts round a drum that are pulled back took 55 to 120 tangents, as
#: one constraint after another stuck or slipped, and by shorter increments they took as many.
CLOSE = 1e-2
#: Up to so many times as many tangents: of layers and beams that lift off each other fronts take 30 to 60, however short increments are.
MOST_TANGENTS = 4
#: What is left is the same within this share: what creeps away from a circle, and may still converge, differs by more.
SAME_MERIT = 1e-3
#: Late updates of the monolithic method are halved that leave more than so many times what was left: they may pass over a hump.
MERIT_GROWTH = 2.0
#: Share of the cone within which a trial counts as slip at the start of an increment (theory 6.5): what slid is off its cone by no more
#: than the tolerances of the last increment, and is not to stick for that.
SLIP_MARGIN = 1e-6
#: How often in a Newton loop what loads close first is closed anew where all has opened again: each time it is nearer.
MAX_CLOSINGS = 5
#: By how much of the largest entry on the diagonal of their tangent loose bodies are held where they are until contact holds them: with a
#: tenth a roller between plates did not come to rest, with nothing three of them were thrown out.
STEADY = 1e-3
#: Merit of an iterate up to which contact holds such bodies by itself: closer to the solution nothing throws them out.
STEADIED_ABOVE = 0.1
#: How many tangents of a Newton loop hold such bodies at most: what has found no hold by then has none.
MAX_STEADIED = 10
#: How often the first solve is repeated with reversed slips held: each repetition may find more of them; the loop settles the rest.
MAX_REVERSALS = 2
#: Forces of a body are round-off below so many times what the last bits of its positions make of them (0.2 to 1.2 times were seen).
ROUND_OFF = 8.0
#: Share of the way of an increment behind which factors are made anew at the end of a stage, where they tell whether it is stable.
STALE = 0.5
#: Share of a body's forces up to which round-off that penalties multiply is left in them: of larger penalties forces would be wrong.
MOST_UNKNOWN = 1e-7

# ---- Contact conditions (theory 5.8, 6.1, 6.4, 7.4, 7.5)

#: Tangential over normal complementarity parameter of the monolithic method. It changes no solution; at one, stick and slip take longer
#: to settle on presses of high order (14 solves per load step at order 4 on 12 x 12 elements, 11 at ten).
TANGENTIAL_FACTOR = 10.0
#: What multipliers resist their own change where conditions may repeat each other (theory 6.4). What no other row tells stays as it is, and
#: the conditions are the same; it is far above round-off, and far below what other rows say.
RESISTANCE = 1e-6
#: Depth inside its master, over the root of the slave's area, from which a control point that supports hold along the normal bears on it
#: (theory 4.11): one that just touches is inside by less, by what the tolerances leave.
SUNK = 1e-6
#: Share of what friction bears that tractions count for at the least (theory 5.8): where nothing pulls, they are round-off.
LEAST_TRACTION = 0.01
#: How far from the contact conditions augmentations may end, in their tolerance, by the norm of their changes: the paper's mixes
#: units and hides the tangential part, which at 0.01 is some per cent off. Its answer stays the paper's, but for what is grossly wrong.
DISTANCE_ALLOWED = {"separate": 1.0, "paper": 10.0}
#: How much more of the multipliers than forces of just `newton_tolerance` change from one augmentation to the next (0.5 to 2.5 were seen).
LEFT_OPEN = 4.0

# ---- The linear system

#: Systems with fewer unknowns than the first are ordered by minimum degree, with more than the second by nested dissection. In between
#: either can take up to twice as long as the other: there the first matrix is factorised both ways.
UNDOUBTED = (1000, 5000)
#: The bodies' Cholesky and what is dense on their faces, so many times the operations of the former, take about as long as general factors,
#: whose operations are slower: boxes on planes and on boxes, 1 to 6 elements thick and wholly in contact, cross at 6 to 9 times.
DENSE_SHARE = 6.0
#: A solution that leaves more than this share of the right-hand side is refined: what is less is gone with Newton's next correction.
REFINED_ABOVE = 1e-6
#: A refined solution that leaves more than this share is none: it has not one digit.
REFUSED_ABOVE = 0.1
#: Most steps of refinement by factors that leave something out; each that is of use takes half of what is left or more.
REFINEMENTS = 30
#: What the diagonal of a singular matrix gets to be factorised, as a share of its largest entry: it is asked for what it leaves free.
SHIFT = 1e-11
