!> Control pressures and tractions of an augmented penalty law, and their derivatives as rows (theory 4).
!>
!> - `slave`, `control`, `law`: the slave side, its control quantities, and what is done with them.
!> - `response`: what the law makes of them. `active` (test functions): whose conditions act.
!> - `pattern`, `rows` (component, kind, blocks): pattern of the constraint rows, and these (isomortar_contact_rows).
!> - `wide`: pattern of the derivatives of the multipliers by positions; `neighbours`: of test functions that share an element.
!> - `trial` (component, trial traction, blocks): derivatives of the trial tractions by positions, F/(L^2 P).
!> - `lacking`: a row of a pattern without one of the blocks, 0: none.
module isomortar_contact_augmentation
  use isomortar_base_contract, only: contracts, require
  use isomortar_base_kinds, only: wp
  use isomortar_base_predicate, only: is_compressed
  use isomortar_contact_control, only: control_t, integrate_slip_sum, least_weight
  use isomortar_contact_friction_elastic_slip, only: elastic_return
  use isomortar_contact_friction_law, only: friction_t
  use isomortar_contact_friction_return_map, only: metric_matrix, return_map, state_open, state_stick
  use isomortar_contact_rows, only: row_metric, row_slip, row_slip_sum, rows_of, rows_t
  use isomortar_contact_sample, only: multipliers_t
  use isomortar_contact_slave, only: slave_t
  use isomortar_sparse_blocks, only: lacks, mark_row, pattern_t
  implicit none
  private

  public :: condense, multiplier_rows, respond

  !> The law: multipliers of the current augmentation, penalties (force per volume), law of friction (not allocated: none).
  type, public :: law_t
    real(wp) :: normal_penalty, tangential_penalty
    class(friction_t), allocatable :: friction
    real(wp), allocatable :: pressure(:)
    real(wp), allocatable :: traction(:, :)
    !> Trials above (1 - slip_margin) of what friction bears slip.
    real(wp) :: slip_margin = 0.0_wp
    !> Take the current traction for the radial part of the slip derivative.
    logical :: forgiving = .false.
    !> Control points that stick whatever their trial; none where not allocated.
    logical, allocatable :: held(:)
    !> Control points that supports do not hold along the normal; the others bear nothing.
    logical, allocatable :: bears(:)
    !> Projection of covariant tractions that leaves nothing along what supports hold, shape (2, 2, I).
    real(wp), allocatable :: free(:, :, :)
    !> Pressure times distance of smooth contact (theory 4.18), F/L; 0: what is apart bears nothing.
    real(wp) :: smoothing = 0.0_wp
    !> Slip is elastic (theory 4.15): `traction` are the stretches at the start of the increment, and the tangential penalty is one
    !> over the largest elastic slip.
    logical :: elastic = .false.
  end type law_t

  !> What the law makes of the control quantities.
  type, public :: response_t
    type(multipliers_t) :: multipliers
    integer, allocatable :: state(:)
    !> d pressure by <R^I g>, shape (I).
    real(wp), allocatable :: pressure_slope(:)
    !> d traction by pressure, trial traction before its projection (2) and metric (3), shape (2, 6, I).
    real(wp), allocatable :: traction_slope(:, :, :)
  end type response_t

contains

  !> What the law makes of the control quantities, with the paper's slip sum if `summed`, whose field of control slips at the
  !> quadrature points is `field_slip` (2, points), P (else zero).
  pure subroutine respond(slave, control, law, summed, response, field_slip)
    type(slave_t), intent(in) :: slave
    type(control_t), intent(in) :: control
    type(law_t), intent(in) :: law
    logical, intent(in) :: summed
    type(response_t), intent(out) :: response
    real(wp), intent(out) :: field_slip(:, :)
    real(wp), allocatable :: slips(:, :), totals(:, :)

    associate (n => slave%test%count)
      allocate (response%multipliers%pressure(n), response%multipliers%traction(2, n), response%multipliers%active(n), &
        response%state(n), response%pressure_slope(n), response%traction_slope(2, 6, n))
      allocate (slips(2, n), totals(2, n))
    end associate
    if (contracts) call require(size(control%weight) == slave%test%count, "respond: control quantities are the slave's")
    if (contracts) call require(size(law%bears) == slave%test%count, "respond: the law is one of its control points")
    field_slip = 0.0_wp
    if (summed) then
      call pressures(control, law, slave%whole, response)
      slips = 0.0_wp
      where (spread(response%multipliers%active, 1, 2)) slips = control%slip / spread(control%weight, 1, 2)
      call integrate_slip_sum(slave, control%point_metric, slips, field_slip, totals)
      call augmented_multipliers(control, law, slave%whole, response, totals)
    else
      call augmented_multipliers(control, law, slave%whole, response)
    end if
    associate (values => response%multipliers)
      if (contracts) call require(.not. any(values%pressure < 0.0_wp), "respond: pressures press")
      if (contracts) call require(all(values%active .eqv. response%state /= state_open), "respond: what is active is closed")
      if (contracts) call require(all(values%active .or. .not. any(abs(values%traction) > 0.0_wp, 1)), "respond: so are tractions")
    end associate
  end subroutine respond

  !> Control pressures with their slopes, and which control points are active (theory 4.3, 4.18): inactive ones have no pressure.
  !>
  !> `whole` is <R^I> over all slave points. A pressure that is not a number is active, so that forces are none either.
  pure subroutine pressures(control, law, whole, response)
    type(control_t), intent(in) :: control
    type(law_t), intent(in) :: law
    real(wp), intent(in) :: whole(:)
    type(response_t), intent(inout) :: response
    real(wp) :: trial, share
    integer :: i

    response%multipliers%active = .false.
    response%multipliers%pressure = 0.0_wp
    response%pressure_slope = 0.0_wp
    do i = 1, size(whole)
      if (control%weight(i) <= least_weight * max(whole(i), 0.0_wp) .or. .not. law%bears(i)) cycle
      trial = law%pressure(i) + law%normal_penalty * control%gap(i) / control%weight(i)
      associate (pressure => response%multipliers%pressure(i))
        call positive_part(trial, law%normal_penalty * law%smoothing, pressure, share)
        response%multipliers%active(i) = .not. pressure <= 0.0_wp
        if (response%multipliers%active(i)) response%pressure_slope(i) = share * law%normal_penalty / control%weight(i)
      end associate
    end do
  end subroutine pressures

  !> What is positive of a trial pressure, and its derivative: the larger root of p (p - trial) = `product` (theory 4.18), with
  !> which nothing is quite zero; of `product` 0 the trial, or 0.
  pure subroutine positive_part(trial, product, pressure, slope)
    real(wp), intent(in) :: trial, product
    real(wp), intent(out) :: pressure, slope
    real(wp) :: apart

    pressure = 0.0_wp
    slope = 1.0_wp
    if (.not. product > 0.0_wp) then
      if (.not. trial <= 0.0_wp) pressure = trial
      return
    end if
    apart = hypot(trial, 2.0_wp * sqrt(product)) ! of the two roots
    if (trial > 0.0_wp) then
      pressure = 0.5_wp * (trial + apart)
    else
      pressure = 2.0_wp * product / (apart - trial)
    end if
    slope = pressure / apart
  end subroutine positive_part

  !> Pressures, tractions and states (theory 4.4, 4.9, 4.15). `slip_sum` is <R^I a_ab zeta^b> for the paper's form (theory 4.5),
  !> absent for the local one.
  pure subroutine augmented_multipliers(control, law, whole, response, slip_sum)
    type(control_t), intent(in) :: control
    type(law_t), intent(in) :: law
    real(wp), intent(in) :: whole(:)
    type(response_t), intent(inout) :: response
    real(wp), intent(in), optional :: slip_sum(:, :)
    real(wp) :: metric(3), trial(2)
    integer :: i

    call pressures(control, law, whole, response)
    response%multipliers%traction = 0.0_wp
    response%state = state_open
    response%traction_slope = 0.0_wp
    do i = 1, size(response%state)
      if (.not. response%multipliers%active(i)) cycle
      response%state(i) = state_stick
      if (.not. allocated(law%friction)) cycle
      metric = control%metric(:, i) / control%square(i)
      if (present(slip_sum)) then
        trial = slip_sum(:, i)
      else
        trial = matmul(metric_matrix(metric), control%slip(:, i))
      end if
      trial = matmul(law%free(:, :, i), law%traction(:, i) + law%tangential_penalty / control%weight(i) * trial)
      call apply_friction(law, i, trial, metric, response)
      response%traction_slope(:, 2:3, i) = matmul(response%traction_slope(:, 2:3, i), law%free(:, :, i))
    end do
  end subroutine augmented_multipliers

  !> Traction, state and slopes of one active control point from its trial traction.
  pure subroutine apply_friction(law, i, trial, metric, response)
    type(law_t), intent(in) :: law
    integer, intent(in) :: i
    real(wp), intent(in) :: trial(2), metric(3)
    type(response_t), intent(inout) :: response

    associate (pressure => response%multipliers%pressure(i), traction => response%multipliers%traction(:, i), &
        slope => response%traction_slope(:, :, i))
      if (law%elastic) then
        call elastic_return(trial, pressure, law%friction, metric, is_held(law, i), traction, response%state(i), slope)
        return
      end if
      if (is_held(law, i)) then
        traction = trial
        response%state(i) = state_stick
        slope = 0.0_wp
        slope(1, 2) = 1.0_wp
        slope(2, 3) = 1.0_wp
        return
      end if
      if (law%forgiving) then
        call return_map(trial, pressure, law%friction, metric, law%slip_margin, traction, response%state(i), slope, &
          law%traction(:, i))
      else
        call return_map(trial, pressure, law%friction, metric, law%slip_margin, traction, response%state(i), slope)
      end if
    end associate
  end subroutine apply_friction

  !> Whether control point `i` sticks whatever its trial.
  pure logical function is_held(law, i)
    type(law_t), intent(in) :: law
    integer, intent(in) :: i

    is_held = .false.
    if (allocated(law%held)) is_held = law%held(i)
  end function is_held

  !> Rows of the trial traction, "local" slip sum (theory 4.10): e_T (m_ab <R^I dxi^b> / w + dm_ab slip^b); blocks are those of
  !> `pattern`.
  pure subroutine trial_rows(control, law, active, pattern, rows, trial)
    type(control_t), intent(in) :: control
    type(law_t), intent(in) :: law
    logical, intent(in) :: active(:)
    type(pattern_t), intent(in) :: pattern
    real(wp), intent(in) :: rows(:, :, :)
    real(wp), intent(out) :: trial(:, :, :)
    integer, parameter :: entry(2, 2) = reshape([0, 1, 1, 2], [2, 2])
    real(wp) :: metric(2, 2), slip(2), factor
    integer :: a, b, i, k

    if (contracts) call require(size(rows, 2) >= row_metric + 2, "trial_rows: there are rows of friction")
    if (contracts) call require(is_compressed(pattern%start, size(rows, 3)), "trial_rows: rows are those of a pattern")
    if (contracts) call require(size(trial, 3) == size(rows, 3), "trial_rows: and so are results")
    trial = 0.0_wp
    do i = 1, size(active)
      if (.not. active(i)) cycle
      metric = metric_matrix(control%metric(:, i) / control%square(i))
      slip = control%slip(:, i) / control%square(i)
      factor = law%tangential_penalty / control%weight(i)
      do k = pattern%start(i - 1) + 1, pattern%start(i)
        do b = 1, 2
          do a = 1, 2
            trial(:, a, k) = trial(:, a, k) + factor * (metric(a, b) * rows(:, row_slip + b - 1, k) &
              + slip(b) * rows(:, row_metric + entry(a, b), k))
          end do
        end do
      end do
    end do
  end subroutine trial_rows

  !> Rows of the trial traction (theory 4.10), the paper's slip sum: e_T / w^I (sum_J M_ab^IJ <R^J dxi^b> / w^J + <R^I da_ab
  !> zeta^b>). `wide` is the pattern of the result, `neighbours` that of M^IJ.
  pure subroutine trial_rows_summed(slave, control, law, active, pattern, rows, neighbours, wide, trial, lacking)
    type(slave_t), intent(in) :: slave
    type(control_t), intent(in) :: control
    type(law_t), intent(in) :: law
    logical, intent(in) :: active(:)
    type(pattern_t), intent(in) :: pattern, neighbours, wide
    real(wp), intent(in) :: rows(:, :, :)
    real(wp), intent(out) :: trial(:, :, :)
    integer, intent(out) :: lacking
    integer, parameter :: entry(2, 2) = reshape([1, 2, 2, 3], [2, 2])
    real(wp), allocatable :: metric(:, :)
    integer, allocatable :: columns(:)
    integer :: a, b, i, j, k, n

    if (contracts) call require(size(rows, 2) > row_slip_sum, "trial_rows_summed: there are rows of the slip sum")
    if (contracts) call require(size(rows, 3) == size(pattern%column), "trial_rows_summed: rows are those of a pattern")
    if (contracts) call require(size(trial, 3) == size(wide%column), "trial_rows_summed: results are those of a pattern")
    allocate (metric(3, size(neighbours%column)), columns(max(maxval(pattern%column), maxval(wide%column))))
    columns = 0
    trial = 0.0_wp
    call pair_metric(slave, control, neighbours, metric, lacking)
    if (lacking > 0) return
    do i = 1, size(active)
      if (.not. active(i)) cycle
      lacking = i
      call mark_row(wide, i, columns)
      if (lacks(wide, i, columns, pattern%column(pattern%start(i - 1) + 1:pattern%start(i)))) return
      associate (factor => law%tangential_penalty / control%weight(i))
        do k = pattern%start(i - 1) + 1, pattern%start(i)
          associate (target => trial(:, :, columns(pattern%column(k))))
            target = target + factor * rows(:, row_slip_sum:row_slip_sum + 1, k)
          end associate
        end do
        do n = neighbours%start(i - 1) + 1, neighbours%start(i)
          j = neighbours%column(n)
          if (.not. active(j)) cycle
          if (lacks(wide, i, columns, pattern%column(pattern%start(j - 1) + 1:pattern%start(j)))) return
          do k = pattern%start(j - 1) + 1, pattern%start(j)
            do b = 1, 2
              do a = 1, 2
                associate (target => trial(:, a, columns(pattern%column(k))))
                  target = target + factor / control%weight(j) * metric(entry(a, b), n) * rows(:, row_slip + b - 1, k)
                end associate
              end do
            end do
          end do
        end do
      end associate
    end do
    lacking = 0
  end subroutine trial_rows_summed

  !> M_ab^IJ = <R^I a_ab R^J> (theory 4.10) as 11, 12, 22 on the pattern of neighbours; `lacking` as above.
  pure subroutine pair_metric(slave, control, neighbours, metric, lacking)
    type(slave_t), intent(in) :: slave
    type(control_t), intent(in) :: control
    type(pattern_t), intent(in) :: neighbours
    real(wp), intent(out) :: metric(:, :)
    integer, intent(out) :: lacking
    integer, allocatable :: columns(:)
    integer :: a, b, e, q

    metric = 0.0_wp
    allocate (columns(slave%test%count), source=0)
    do e = 1, size(slave%test%nodes, 2)
      do a = 1, size(slave%test%nodes, 1)
        lacking = slave%test%nodes(a, e)
        call mark_row(neighbours, lacking, columns)
        if (lacks(neighbours, lacking, columns, slave%test%nodes(:, e))) return
        do q = (e - 1) * slave%per_element + 1, e * slave%per_element
          do b = 1, size(slave%test%nodes, 1)
            associate (target => metric(:, columns(slave%test%nodes(b, e))))
              target = target + slave%test%values(a, q) * slave%test%values(b, q) * slave%area(q) * control%point_metric(:, q)
            end associate
          end do
        end do
      end do
    end do
    lacking = 0
  end subroutine pair_metric

  !> Rows of the multipliers p, t_1, t_2 (theory 4.8, 4.9), and of the trial tractions: on `wide`, which is `pattern` unless there
  !> is the paper's slip sum.
  !>
  !> - `result` (component, multiplier, block): F/L^3 and F/(L^2 P).
  pure subroutine multiplier_rows(slave, control, law, response, pattern, rows, neighbours, wide, trial, result, lacking)
    type(slave_t), intent(in) :: slave
    type(control_t), intent(in) :: control
    type(law_t), intent(in) :: law
    type(response_t), intent(in) :: response
    type(pattern_t), intent(in) :: pattern, neighbours, wide
    real(wp), intent(in) :: rows(:, :, :)
    real(wp), intent(out) :: trial(:, :, :), result(:, :, :)
    integer, intent(out) :: lacking
    type(rows_t) :: there

    there = rows_of(size(rows, 2))
    if (contracts) call require(there%slip_sum .or. all(wide%start == pattern%start), "multiplier_rows: one pattern is the other")
    if (there%slip_sum) then
      call trial_rows_summed(slave, control, law, response%state /= state_open, pattern, rows, neighbours, wide, trial, lacking)
      if (lacking > 0) then
        result = 0.0_wp
        return
      end if
    else if (there%friction) then
      call trial_rows(control, law, response%state /= state_open, pattern, rows, trial)
    else
      trial = 0.0_wp
    end if
    call rows_of_law(control, response, pattern, rows, wide, trial, result, lacking)
  end subroutine multiplier_rows

  !> Rows of the multipliers (theory 4.8, 4.9) from those of the trial tractions.
  pure subroutine rows_of_law(control, response, pattern, rows, wide, trial, result, lacking)
    type(control_t), intent(in) :: control
    type(response_t), intent(in) :: response
    type(pattern_t), intent(in) :: pattern, wide
    real(wp), intent(in) :: rows(:, :, :), trial(:, :, :)
    real(wp), intent(out) :: result(:, :, :)
    integer, intent(out) :: lacking
    integer, allocatable :: columns(:)
    type(rows_t) :: there
    integer :: i, k

    there = rows_of(size(rows, 2))
    allocate (columns(max(maxval(pattern%column), maxval(wide%column))))
    if (contracts) call require(size(rows, 3) == size(pattern%column), "rows_of_law: rows are those of a pattern")
    if (contracts) call require(size(result, 3) == size(wide%column), "rows_of_law: results are those of a pattern")
    if (contracts) call require(size(trial, 3) == size(wide%column), "rows_of_law: so are rows of the trial tractions")
    columns = 0
    result = 0.0_wp
    do i = 1, size(response%state)
      if (response%state(i) == state_open) cycle
      lacking = i
      call mark_row(wide, i, columns)
      if (lacks(wide, i, columns, pattern%column(pattern%start(i - 1) + 1:pattern%start(i)))) return
      do k = pattern%start(i - 1) + 1, pattern%start(i)
        associate (target => result(:, :, columns(pattern%column(k))), by => response%traction_slope(:, :, i))
          target(:, 1) = response%pressure_slope(i) * rows(:, there%gap, k)
          if (.not. there%friction) cycle
          target(:, 2:3) = matmul(rows(:, row_metric:row_metric + 2, k) / control%square(i), transpose(by(:, 4:6)))
          target(:, 2) = target(:, 2) + by(1, 1) * target(:, 1)
          target(:, 3) = target(:, 3) + by(2, 1) * target(:, 1)
        end associate
      end do
      if (.not. there%friction) cycle
      do k = wide%start(i - 1) + 1, wide%start(i)
        result(:, 2:3, k) = result(:, 2:3, k) + matmul(trial(:, :, k), transpose(response%traction_slope(:, 2:3, i)))
      end do
    end do
    lacking = 0
  end subroutine rows_of_law

  !> Add sum_I <R^I dg> Dp^I + <R^I ds^a> Dt_a^I (theory 4.8) to a matrix of blocks.
  !>
  !> - `changes` (component, multiplier, blocks): rows of the multipliers, on `wide`.
  !> - `target_pattern`, `target` (column component, row component, blocks): that matrix, F/L.
  pure subroutine condense(active, pattern, rows, wide, changes, target_pattern, target, lacking)
    logical, intent(in) :: active(:)
    type(pattern_t), intent(in) :: pattern, wide, target_pattern
    real(wp), intent(in) :: rows(:, :, :), changes(:, :, :)
    real(wp), intent(inout) :: target(:, :, :)
    integer, intent(out) :: lacking
    integer, allocatable :: columns(:)
    type(rows_t) :: there
    integer :: a, b, i, multipliers

    there = rows_of(size(rows, 2))
    if (contracts) call require(is_compressed(target_pattern%start, size(target, 3)), "condense: blocks are those of a pattern")
    if (contracts) call require(is_compressed(wide%start, size(changes, 3)), "condense: changes are those of a pattern")
    allocate (columns(size(target_pattern%start) - 1), source=0)
    multipliers = merge(3, 1, there%friction)
    do i = 1, size(active)
      if (.not. active(i)) cycle
      do a = pattern%start(i - 1) + 1, pattern%start(i)
        lacking = pattern%column(a)
        call mark_row(target_pattern, lacking, columns)
        if (lacks(target_pattern, lacking, columns, wide%column(wide%start(i - 1) + 1:wide%start(i)))) return
        do b = wide%start(i - 1) + 1, wide%start(i)
          associate (block => target(:, :, columns(wide%column(b))))
            block = block + matmul(changes(:, 1:multipliers, b), transpose(rows(:, 1:multipliers, a)))
          end associate
        end do
      end do
    end do
    lacking = 0
  end subroutine condense

end module isomortar_contact_augmentation
