C     f77.f: the FORTRAN 77 layer beyond the example: texts, options and
C     results by key, node pairs, contact over the cycle, errors, cancel
C     and remarks. Prints what fails; STOP 1.
      PROGRAM F77
      INTEGER NFAIL
      COMMON /FAILED/ NFAIL
      NFAIL = 0
      CALL FACTS
      CALL RUN
      CALL SUPER
      IF (NFAIL .GT. 0) STOP 1
      WRITE (*, *) 'ALL PROPERTIES HOLD'
      END

      SUBROUTINE CHECK(LHOLDS, TEXT)
      LOGICAL LHOLDS
      CHARACTER*(*) TEXT
      INTEGER NFAIL
      COMMON /FAILED/ NFAIL
      IF (LHOLDS) RETURN
      WRITE (*, *) 'FAILED: ', TEXT
      NFAIL = NFAIL + 1
      END

      SUBROUTINE FACTS
      INCLUDE 'plmf.inc'
      INTEGER I, J, K, N, ITYPE, ISOPT, IERR
      DOUBLE PRECISION DMIN, DMAX
      CHARACTER*80 TEXT
      CHARACTER*4 SHORT
      CALL PLMVER(I, J, K, IERR)
      CALL CHECK(IERR .EQ. PLMOK .AND. I + J + K .GT. 0, 'version')
      CALL PLMBLD(TEXT, IERR)
      CALL CHECK(IERR .EQ. PLMOK .AND. TEXT .NE. ' ', 'build line')
      CALL PLMSTX(PLMEKY, TEXT, IERR)
      CALL PLMSTX(PLMEKY, SHORT, IERR)
      CALL CHECK(IERR .EQ. PLMOK .AND. SHORT .EQ. TEXT(1:4), 'cut text')
      CALL PLMKCN(PLMKHB, N, IERR)
      CALL CHECK(IERR .EQ. PLMOK .AND. N .GT. 5, 'number of keys')
      CALL PLMKTX(PLMKHB, 1, PLMKNM, TEXT, IERR)
      CALL CHECK(TEXT .EQ. 'n_harmonics', 'name of the first key')
      CALL PLMKIN(PLMKHB, 1, ITYPE, ISOPT, DMIN, DMAX, IERR)
      CALL CHECK(ITYPE .EQ. 1 .AND. ISOPT .EQ. 1 .AND. DMIN .LE. 1.0D0,
     1           'first key')
      END

C     a superelement: one coordinate of two masses, T = (0.5, 1)
      SUBROUTINE SUPER
      INCLUDE 'plmf.inc'
      INTEGER*8 LCTX, MODEL, CURVE, LHBM
      INTEGER IERR, N
      DOUBLE PRECISION X(1), F(1), Q(3), FULL(2, 3), AMPL(4000)
      DOUBLE PRECISION FREQ, PEAK, ERR, A1
      EXTERNAL BACK
      CALL PLMCCR(LCTX, IERR)
      CALL PLMCTH(LCTX, 2, IERR)
      CALL PLMCTE(LCTX, 20D0, IERR)
      CALL CHECK(IERR .EQ. PLMOK, 'threads')
      CALL PLMMCR(LCTX, 1, MODEL, IERR)
      X(1) = 1.25D0
      CALL PLMMDM(MODEL, PLMMAS, PLMFUL, X, 1, IERR)
      CALL CHECK(IERR .EQ. PLMOK, 'dense mass')
      X(1) = 5D3
      CALL PLMMDM(MODEL, PLMSTF, PLMLOW, X, 1, IERR)
      F(1) = 1D0
      Q(1) = 1D-5
      CALL PLMMDG(MODEL, 1, F, 1, X, Q, IERR)
      CALL CHECK(IERR .EQ. PLMOK, 'dense gap row')
      CALL PLMMEX(MODEL, 1, 1, F, F, IERR)
      CALL PLMMRD(MODEL, 0D0, 5D-4, IERR)
      CALL PLMMNV(MODEL, IERR)
      CALL CHECK(IERR .EQ. PLMOK, 'no recovery')
      CALL PLMMRV(MODEL, 2, BACK, IERR)
      CALL PLMMBU(MODEL, IERR)
      CALL CHECK(IERR .EQ. PLMOK, 'superelement is built')
      Q(1) = 1D0
      Q(2) = 2D0
      Q(3) = 4D0
      CALL PLMMRC(MODEL, 3, Q, 2, FULL, IERR)
      CALL CHECK(IERR .EQ. PLMOK .AND. ABS(FULL(1, 3) - 2D0) .LT. 1D-12
     1           .AND. ABS(FULL(2, 3) - 4D0) .LT. 1D-12, 'recovered')
      CALL PLMMRP(MODEL, 1, PLMPKM, 1D-2, FREQ, PEAK, ERR, CURVE, LHBM,
     1            IERR)
      CALL PLMMRA(MODEL, CURVE, 1, PLMPKM, 0, 4000, AMPL, N, IERR)
      A1 = AMPL(N / 2)
      CALL PLMMRA(MODEL, CURVE, 2, PLMPKM, 0, 4000, AMPL, N, IERR)
      CALL CHECK(ABS(AMPL(N / 2) - 2 * A1) .LE. 1D-12 * AMPL(N / 2),
     1           'amplitudes are recovered')
      Q(1) = -1D9
      CALL PLMMRC(MODEL, 1, Q, 2, FULL, IERR)
      CALL CHECK(IERR .EQ. PLMECB, 'a failed recovery')
      CALL PLMCDE(LCTX, IERR)
      END

      SUBROUTINE BACK(NDOF, NCOL, Q, NFULL, FULL, IFAIL)
      INTEGER NDOF, NCOL, NFULL, IFAIL, I
      DOUBLE PRECISION Q(NDOF, NCOL), FULL(NFULL, NCOL)
      DO 10 I = 1, NCOL
          FULL(1, I) = 0.5D0 * Q(1, I)
          FULL(2, I) = Q(1, I)
   10 CONTINUE
      IF (Q(1, 1) .LT. -1D8) IFAIL = 1
      END

C     two nodes that clap: each on its own spring, three DOFs, a pair
      SUBROUTINE RUN
      INCLUDE 'plmf.inc'
      INTEGER NDOF, NT
      PARAMETER (NDOF = 6, NT = 16)
      INTEGER*8 LCTX, MODEL, IBASIS, LHBM, CURVE
      INTEGER I, IERR, N, ISTAT, IREASN, INDEX, ICODE
      INTEGER IDIAG(NDOF), IA(3), IB(3), ICLOSD(NT), IT(2000)
      DOUBLE PRECISION XM(NDOF), XK(NDOF), XNORM(3), FRE(NDOF)
      DOUBLE PRECISION FIM(NDOF), HZ(2000), AMPL(2000), PEN(NT), FRC(NT)
      DOUBLE PRECISION FREQ(2), SHAPE(NDOF, 2), R
      CHARACTER*200 TEXT
      EXTERNAL WATCH, REMARK
      INTEGER NCALLS, NSTOPS, NLINES
      COMMON /COUNTS/ NCALLS, NSTOPS, NLINES
      DATA IA /1, 2, 3/, IB /4, 5, 6/
      DATA XNORM /1.0D0, 0.0D0, 0.0D0/
      NCALLS = 0
      NSTOPS = 100000
      NLINES = 0
      LCTX = 0
      DO 10 I = 1, NDOF
        IDIAG(I) = I
        XM(I) = 1.0D0
        XK(I) = 1.0D4 * I
        FRE(I) = 0.0D0
        FIM(I) = 0.0D0
   10 CONTINUE
      FIM(1) = 5.0D0
      CALL PLMCCR(LCTX, IERR)
      CALL CHECK(IERR .EQ. PLMOK .AND. LCTX .NE. 0, 'context')
      CALL PLMCSL(LCTX, REMARK, IERR)
      MODEL = 0
      CALL PLMMCR(LCTX, NDOF, MODEL, IERR)
      CALL PLMMMX(MODEL, PLMMAS, PLMTRI, PLMFUL, NDOF, IDIAG, IDIAG, XM,
     1            IERR)
      CALL PLMMMX(MODEL, PLMSTF, PLMTRI, PLMFUL, NDOF, IDIAG, IDIAG, XK,
     1            IERR)
      CALL PLMMRD(MODEL, 1.0D0, 1.0D-4, IERR)
      CALL PLMMNP(MODEL, 1, IA, IB, XNORM, 2.0D4, 0.0D0, IERR)
      CALL CHECK(IERR .EQ. PLMOK, 'node pair')
      CALL PLMMEX(MODEL, 1, NDOF, FRE, FIM, IERR)
      CALL PLMMSI(MODEL, 'max_blcks', 3, IERR)
      CALL PLMCET(LCTX, TEXT, I)
      CALL CHECK(IERR .EQ. PLMEKY, 'wrong key')
      CALL CHECK(TEXT(1:17) .EQ. 'plm_model_set_int', 'error text')
      CALL PLMCEI(LCTX, ISTAT, IREASN, INDEX, ICODE, I)
      CALL CHECK(ISTAT .EQ. PLMEKY .AND. IREASN .EQ. PLMRNO, 'status')
      CALL PLMMBU(PLMNUL, IERR)
      CALL CHECK(IERR .EQ. PLMEHD, 'handle 0')
      CALL PLMMBU(MODEL, IERR)
      CALL CHECK(IERR .EQ. PLMOK, 'build')
      CALL PLMMMO(MODEL, PLMGIV, 1, 2, FREQ, SHAPE, IERR)
C     closed: the x motion of the pair and the y motion of node a both
C     have lambda = 2.0D4
      DO 15 I = 1, 2
        CALL CHECK(IERR .EQ. PLMOK .AND.
     1             ABS(FREQ(I) - 22.5079079D0) .LT. 1.0D-6, 'modes')
   15 CONTINUE
      IBASIS = 0
      CALL PLMBCR(MODEL, IBASIS, IERR)
      CALL PLMBSC(IBASIS, 'kind', 'full', IERR)
      CALL PLMBGC(IBASIS, 'kind   ', TEXT, IERR)
      CALL CHECK(TEXT .EQ. 'full', 'a word is set and read')
      CALL PLMBSD(IBASIS, 'frequency_min_hz', 14.0D0, IERR)
      CALL PLMBSD(IBASIS, 'frequency_max_hz', 24.0D0, IERR)
      CALL PLMBBU(IBASIS, IERR)
      CALL CHECK(IERR .EQ. PLMOK, 'basis')
      CALL PLMBGD(IBASIS, 'frequency_max_hz', R, IERR)
      CALL CHECK(ABS(R - 24.0D0) .LE. 0.0D0, 'a real is set and read')
      LHBM = 0
      CURVE = 0
      CALL PLMHCR(IBASIS, LHBM, IERR)
      CALL PLMHSW(LHBM, CURVE, IERR)
      CALL CHECK(IERR .EQ. PLMOK, 'sweep')
      CALL PLMRGA(CURVE, 'frequency_hz', 2000, HZ, N, IERR)
      CALL CHECK(IERR .EQ. PLMOK .AND. N .GT. 5, 'an array')
      CALL CHECK(HZ(1) .GT. HZ(N), 'a sweep goes down')
      CALL PLMRGN(CURVE, 'iterations', 2000, IT, I, IERR)
      CALL CHECK(IERR .EQ. PLMOK .AND. I .EQ. N, 'an integer array')
      CALL PLMRGN(CURVE, 'iterations', 1, IT, I, IERR)
      CALL CHECK(IERR .EQ. PLMEAR, 'an array too short')
      CALL PLMRAM(CURVE, 1, PLMPKM, 0, 2000, AMPL, I, IERR)
      CALL CHECK(IERR .EQ. PLMOK .AND. AMPL(N) .GT. 0.0D0, 'amplitude')
      CALL PLMRCT(CURVE, N, NT, PEN, FRC, ICLOSD, IERR)
      DO 20 I = 1, NT
        CALL CHECK((ICLOSD(I) .EQ. 1) .EQV. (PEN(I) .GT. 0.0D0),
     1             'closed where the penetration is positive')
   20 CONTINUE
      CALL STUDY(MODEL, LHBM)
      CALL PLMHSI(LHBM, 'max_points', 3, IERR)
      CALL PLMHSW(LHBM, CURVE, IERR)
      CALL CHECK(IERR .EQ. PLMTRU, 'truncated')
      CALL PLMCET(LCTX, TEXT, IERR)
      CALL CHECK(TEXT(1:25) .EQ. 'plm_hbm_sweep: max_points',
     1           'text of an outcome')
      CALL PLMHSI(LHBM, 'max_points', 1000, IERR)
      NSTOPS = 8
      CALL PLMCSP(LCTX, WATCH, IERR)
      CALL PLMHSW(LHBM, CURVE, IERR)
      CALL CHECK(IERR .EQ. PLMCAN, 'cancelled')
      CALL CHECK(NLINES .GT. 0, 'remarks')
      CALL PLMCDE(LCTX, IERR)
      CALL CHECK(IERR .EQ. PLMOK .AND. LCTX .EQ. 0, 'destroy')
      END

C     one harmonic against those the curve chose: a name that is too
C     long for its place, an array that is too short, method 0, files
      SUBROUTINE STUDY(MODEL, LHBM)
      INCLUDE 'plmf.inc'
      INTEGER*8 MODEL, LHBM, ISTUDY, CURVE
      INTEGER IERR, NUMBER, N, I
      DOUBLE PRECISION ERR(1), HZ(2000), AMPL(2000), R
      CHARACTER*4 SHORT
      CHARACTER*80 TEXT
      ISTUDY = 0
      CURVE = 0
      CALL PLMYCR(MODEL, ISTUDY, IERR)
      CALL CHECK(IERR .EQ. PLMOK .AND. ISTUDY .NE. 0, 'study')
      CALL PLMYSO(ISTUDY, 1, PLMPPM, 0, IERR)
      CALL PLMYSI(ISTUDY, 'repeats', 1, IERR)
      CALL PLMYSD(ISTUDY, 'curve_tolerance', 1D-4, IERR)
      CALL PLMYFL(ISTUDY, 1, 1.0D0, IERR)
      CALL CHECK(IERR .EQ. PLMOK, 'force level')
      CALL PLMYRF(ISTUDY, LHBM, IERR)
      CALL CHECK(IERR .EQ. PLMOK, 'reference')
      CALL PLMHSI(LHBM, 'n_harmonics', 1, IERR)
      CALL PLMYAR(ISTUDY, 'one harmonic', LHBM, NUMBER, IERR)
      CALL CHECK(IERR .EQ. PLMOK .AND. NUMBER .EQ. 1, 'first method')
      CALL PLMHSI(LHBM, 'n_harmonics', 0, IERR)
      CALL PLMYAR(ISTUDY, 'one harmonic', LHBM, NUMBER, IERR)
      CALL CHECK(IERR .EQ. PLMEAR .AND. NUMBER .EQ. 1, 'used name')
      CALL PLMYOU(ISTUDY, 1, TEXT, IERR)
      CALL CHECK(IERR .EQ. PLMEST, 'outcome before a run')
      CALL PLMYRN(ISTUDY, IERR)
      CALL CHECK(IERR .EQ. PLMOK, 'run')
      CALL PLMYNM(ISTUDY, 1, SHORT, IERR)
      CALL CHECK(IERR .EQ. PLMOK .AND. SHORT .EQ. 'one ', 'cut name')
      CALL PLMYOU(ISTUDY, 0, TEXT, IERR)
      CALL CHECK(TEXT .EQ. 'reached the end of its range', 'outcome')
      CALL PLMYGA(ISTUDY, 'amplitude_error', 1, ERR, N, IERR)
      CALL CHECK(N .EQ. 1 .AND. ERR(1) .GT. 1D-6, 'error')
      CALL CHECK(ERR(1) .LT. 1D0, 'error below 1')
      CALL PLMYCU(ISTUDY, 1, 1, CURVE, IERR)
      CALL PLMRGI(CURVE, 'n_harmonics', N, IERR)
      CALL CHECK(IERR .EQ. PLMOK .AND. N .EQ. 1, 'curve')
      CALL PLMYPT(ISTUDY, 1, 1, 1, HZ, AMPL, N, IERR)
      CALL CHECK(IERR .EQ. PLMEAR, 'points in arrays too short')
      CALL PLMYPT(ISTUDY, 1, 1, 2000, HZ, AMPL, N, IERR)
      CALL CHECK(IERR .EQ. PLMOK .AND. N .GT. 5, 'points')
      R = 0.0D0
      DO 10 I = 1, N
        R = MAX(R, AMPL(I))
   10 CONTINUE
      CALL PLMYGA(ISTUDY, 'peak_amplitude', 1, ERR, N, IERR)
      CALL CHECK(ABS(R / ERR(1) - 1.0D0) .LT. 1D-2, 'highest point')
      CALL PLMYWR(ISTUDY, 'no/such/folder', IERR)
      CALL CHECK(IERR .EQ. PLMEAR, 'files')
      CALL PLMYRF(ISTUDY, PLMNUL, IERR)
      CALL CHECK(IERR .EQ. PLMOK, 'no reference')
      CALL PLMYDE(ISTUDY, IERR)
      CALL CHECK(IERR .EQ. PLMOK .AND. ISTUDY .EQ. 0, 'study gone')
      END

      SUBROUTINE WATCH(STAGE, FRACTN, ICANCL)
      CHARACTER*(*) STAGE
      DOUBLE PRECISION FRACTN
      INTEGER ICANCL, NCALLS, NSTOPS, NLINES
      COMMON /COUNTS/ NCALLS, NSTOPS, NLINES
      IF (STAGE .NE. ' ' .AND. FRACTN .GE. 0.0D0) NCALLS = NCALLS + 1
      IF (NCALLS .GE. NSTOPS) ICANCL = 1
      END

      SUBROUTINE REMARK(LEVEL, TEXT)
      INTEGER LEVEL, NCALLS, NSTOPS, NLINES
      CHARACTER*(*) TEXT
      COMMON /COUNTS/ NCALLS, NSTOPS, NLINES
      IF (LEVEL .GE. 0 .AND. TEXT .NE. ' ') NLINES = NLINES + 1
      END
